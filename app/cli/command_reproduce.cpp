#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "study/reproduce.h"

namespace clothlab::cli {
namespace {

std::atomic<bool> stop_requested{false};
extern "C" void stop_reproduce(int) {
  stop_requested = true;
}

/// What is being measured and how long it will still take; nothing where standard error is no terminal.
class StudyProgress {
 public:
  StudyProgress() : shown_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_) {}
  ~StudyProgress() {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }
  void show(const cloth::ReproduceProgress& progress) {
    const auto now = Clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    constexpr int width = 30;
    const int filled = static_cast<int>(std::lround(progress.fraction * width));
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        progress.fraction > 0.02
            ? fmt::format("{:.0f} s left", elapsed * (1 - progress.fraction) / progress.fraction)
            : "";
    fmt::print(stderr, "\r\033[K[{:=<{}}{:<{}}] {:3.0f} %  {}  {}", "", filled, "", width - filled,
               100 * progress.fraction, progress.part, left);
    std::fflush(stderr);
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  Clock::time_point start_, last_;
};

std::string result_json(const cloth::ReproduceResult& result, const std::string& folder) {
  nlohmann::ordered_json json{{"status", result.stopped ? "stopped" : "finished"}, {"folder", folder}};
  json["files"] = result.files;
  json["numbers"] = nlohmann::ordered_json::array();
  for (const cloth::Measured& number : result.numbers) {
    nlohmann::ordered_json entry{
        {"part", number.part}, {"name", number.name}, {"unit", number.unit}, {"value", number.value}};
    if (number.expected) entry["expected"] = *number.expected;
    json["numbers"].push_back(std::move(entry));
  }
  return json.dump(2) + "\n";
}

std::string result_text(const cloth::ReproduceResult& result, const std::string& folder) {
  std::string text;
  for (const cloth::Measured& number : result.numbers) {
    if (!number.expected) continue;
    text += fmt::format("{:<12} {:<58} {:>10.4g} {:<4} expected {:.4g}\n", number.part, number.name,
                        number.value, number.unit, *number.expected);
  }
  return text + fmt::format("{}: {}/report.html\n", result.stopped ? "stopped" : "finished", folder);
}

}  // namespace

int reproduce(const ReproduceArguments& arguments) {
  std::signal(SIGINT, stop_reproduce);
  std::signal(SIGTERM, stop_reproduce);
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of write, not the end of the process

  cloth::ReproduceResult result;
  {
    StudyProgress bar;
    result = cloth::reproduce({.folder = arguments.folder,
                               .only = arguments.only,
                               .progress = [&](const cloth::ReproduceProgress& progress) {
                                 bar.show(progress);
                                 return !stop_requested.load();
                               }});
  }
  if (result.io_error) return report(*result.io_error);
  const int printed =
      print(arguments.json ? result_json(result, arguments.folder) : result_text(result, arguments.folder));
  if (printed != done) return printed;
  return result.stopped ? interrupted : done;
}

}  // namespace clothlab::cli
