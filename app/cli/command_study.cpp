#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "study/study_folder.h"

namespace clothlab::cli {

int study(const StudyArguments& arguments) {
  const cloth::StudyReading reading = cloth::read_study(arguments.folder);
  if (!reading.study) {
    say(reading.problem);
    return reading.is_lost ? io_failed : bad_input;
  }
  const cloth::StudyTable& table = reading.study->table;
  if (arguments.json) return print(cloth::study_json_text(table));
  if (arguments.csv) return print(cloth::study_csv(table));
  const std::string head =
      fmt::format("{}: {}{}\n{}\n\n", cloth::kind_of(table), cloth::title_of(table),
                  cloth::is_complete(table) ? "" : " (stopped before its end)", reading.study->command);
  return print(head + cloth::study_text(table));
}

}  // namespace clothlab::cli
