#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "study/study_folder.h"

namespace clothlab::cli {
namespace {

struct StudyArguments {
  std::string folder;
  bool json = false, csv = false;
};

int study(const StudyArguments& arguments) {
  const cloth::StudyReading reading = cloth::read_study(arguments.folder);
  if (!reading.study) {
    say(reading.problem);
    return reading.is_lost ? io_failed : bad_input;
  }
  const cloth::StudyTable& table = reading.study->table;
  if (arguments.json) return print(cloth::study_json(table));
  if (arguments.csv) return print(cloth::study_csv(table));
  const std::string& shard = reading.study->shard;
  const std::string part = !shard.empty()              ? fmt::format(" (shard {})", shard)
                           : cloth::is_complete(table) ? ""
                                                       : " (stopped before its end)";
  const std::string head = fmt::format("{}: {}{}\n{}\n\n", cloth::kind_of(table), cloth::title_of(table),
                                       part, reading.study->command);
  return print(head + cloth::study_text(table));
}

}  // namespace

void add_study(Program& program) {
  auto [command, arguments] = add_command(
      program, "study",
      "Print the table of a study's folder, whether the command line or the window wrote it", study);
  command.add_option("folder", arguments.folder, "A folder with a study.json")->required();
  CLI::Option* json = add_json(command, arguments.json);
  command.add_flag("--csv", arguments.csv, "Print every run as CSV")->excludes(json);
}

}  // namespace clothlab::cli
