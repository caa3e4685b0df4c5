#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "progress.h"
#include "study/reproduce.h"

namespace clothlab::cli {
namespace {

struct ReproduceArguments {
  std::string folder;
  std::vector<std::string> only;
  bool overwrite = false;  ///< an unfinished reproduction of other parts
  bool json = false;
};

std::string result_json(const cloth::ReproduceResult& result, const std::string& folder) {
  nlohmann::ordered_json document{{"status", result.stopped ? "stopped" : "finished"}, {"folder", folder}};
  document["files"] = result.files;
  document["numbers"] = nlohmann::ordered_json::array();
  for (const cloth::Measured& number : result.numbers) {
    nlohmann::ordered_json entry{
        {"part", number.part}, {"name", number.name}, {"unit", number.unit}, {"value", number.value}};
    if (number.expected) entry["expected"] = *number.expected;
    document["numbers"].push_back(std::move(entry));
  }
  return document.dump(2) + "\n";
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

int reproduce(const ReproduceArguments& arguments) {
  listen_for_stop();

  cloth::ReproduceResult result;
  {
    Progress bar;
    result = cloth::reproduce(
        {.folder = arguments.folder,
         .only = arguments.only,
         .progress =
             [&](const cloth::ReproduceProgress& progress) {
               bar.show(progress.fraction, progress.part);
               return !stop_is_requested();
             },
         .overwrite = arguments.overwrite,
         .goes_on =
             [](int parts) {
               say(fmt::format("going on with the unfinished reproduction in the folder: {} parts are there",
                               parts));
             }});
  }
  if (result.io_error) return report(*result.io_error);
  const int printed =
      print(arguments.json ? result_json(result, arguments.folder) : result_text(result, arguments.folder));
  if (printed != done) return printed;
  return result.stopped ? interrupted : done;
}

}  // namespace

void add_reproduce(Program& program) {
  auto [command, arguments] = add_command(
      program, "reproduce",
      "Measure the source report's figures, its Table 1 and its errata; one report.html", reproduce);
  add_path(command, "--out", arguments.folder, "Folder for report.html and its pictures")->required();
  add_names(
      command, "--only", arguments.only,
      fmt::format("Only these parts, separated by commas: {}", fmt::join(cloth::reproduce_parts(), ", ")),
      cloth::reproduce_parts());
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
