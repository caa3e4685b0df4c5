#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>

#include "console.h"
#include "io/printable.h"

namespace clothlab::cli {
namespace {

std::atomic<bool> stop_requested{false};
extern "C" void note_stop(int) {
  stop_requested = true;
}

std::string remaining_text(double seconds) {
  const auto whole = static_cast<int>(std::ceil(seconds));
  return whole < 60 ? fmt::format("{} s left", whole)
                    : fmt::format("{} min {:02} s left", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress() : shown_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) write_error("\r\033[K");
}

void Progress::show(double fraction, const std::string& text) {
  if (!shown_) return;
  const auto now = Clock::now();
  if (now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  constexpr int width = 30;
  const double part = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(std::lround(part * width));
  std::string line =
      fmt::format("\r\033[K[{:=<{}}{:<{}}] {:3.0f} %", "", filled, "", width - filled, 100 * part);
  if (part > 0.02) {
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    line += "  " + remaining_text(elapsed * (1 - part) / part);
  }
  write_error(line + "  " + cloth::printable(text));
}

void listen_for_stop() {
  std::signal(SIGINT, note_stop);
  std::signal(SIGTERM, note_stop);
  // Under nohup a closed terminal is to be ignored, and stays so.
  if (std::signal(SIGHUP, note_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool stop_is_requested() {
  return stop_requested.load();
}

}  // namespace clothlab::cli
