#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "commands.h"
#include "console.h"
#include "io/result_folder.h"
#include "progress.h"
#include "study/validation/strip_bench.h"
#include "study/validation/validation_report.h"

namespace clothlab::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> only;
  std::string folder, strips, scored;
  bool json = false;
};

using Rows = std::vector<cloth::ValidationRow>;

std::optional<cloth::IoError> write_folder(cloth::ResultFolder& folder, const Rows& rows,
                                           const std::string& command, double wall) {
  if (const auto error = folder.write("validation.csv", cloth::validation_csv(rows), true)) return error;
  if (const auto error = folder.write("report.html", cloth::validation_page(rows, command, wall)))
    return error;
  return folder.finish("validation.json", cloth::validation_json(rows, folder.digests()));
}

/// The strips for other simulators.
int write_strips(const std::string& place) {
  const Rows tasks = cloth::strip_tasks();
  std::vector<std::pair<std::string, std::string>> files{{"strips.csv", cloth::strips_csv(tasks)}};
  for (const cloth::ValidationRow& task : tasks) {
    files.emplace_back(name_of(task) + ".start.obj", cloth::starting_obj(task));
    files.emplace_back(name_of(task) + ".exact.csv", cloth::curve_csv(task.curve));
  }
  cloth::ResultFolder folder;
  cloth::FolderUse use{.kind = "strips", .files = {"strips.json"}};
  for (const auto& [name, text] : files) use.files.push_back(name);
  if (const auto error = folder.claim(place, use)) return report(*error);
  for (const auto& [name, text] : files)
    if (const auto error = folder.write(name, text, name.ends_with(".csv"))) return report(*error);
  if (const auto error = folder.finish("strips.json", cloth::strips_index(folder.digests())))
    return report(*error);
  return print(fmt::format("{} strips in {}\n", tasks.size(), place));
}

int score(const ValidateArguments& arguments) {
  std::vector<cloth::StripScore> scores;
  if (const auto error = cloth::score_folder(arguments.scored, scores)) return report(*error);
  const int printed = print(arguments.json ? cloth::score_json(scores) : cloth::score_text(scores));
  if (printed != done) return printed;
  return std::all_of(scores.begin(), scores.end(), [](const auto& one) { return one.failure.empty(); })
             ? done
             : bad_input;
}

/// Every row as it is done; false where it was stopped.
bool measure(const std::vector<std::string>& protocols, Rows& rows) {
  Progress bar;
  bar.show(0, "exact solutions");
  Rows expected = cloth::validation_rows(protocols);
  const std::size_t all = expected.size();
  return cloth::validate(
      std::move(expected),
      [&](cloth::ValidationRow row) {
        rows.push_back(std::move(row));
        bar.show(static_cast<double>(rows.size()) / static_cast<double>(all), rows.back().protocol);
      },
      stop_is_requested);
}

int validate(const ValidateArguments& arguments) {
  if (!arguments.strips.empty()) return write_strips(arguments.strips);
  if (!arguments.scored.empty()) return score(arguments);
  listen_for_stop();
  const auto protocols = arguments.only.empty() ? cloth::exact_protocols() : arguments.only;
  cloth::ResultFolder folder;
  if (!arguments.folder.empty()) {
    const std::vector<std::string> files{"validation.csv", "report.html", "validation.json"};
    if (const auto error = folder.claim(arguments.folder, {.kind = "validation", .files = files}))
      return report(*error);
  }
  const auto start = std::chrono::steady_clock::now();
  Rows rows;
  const bool is_whole = measure(protocols, rows);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (folder.is_open()) {
    std::string command = "clothlab-cli validate";
    if (!arguments.only.empty()) command += fmt::format(" --only {}", fmt::join(arguments.only, ","));
    if (const auto error = write_folder(folder, rows, command + " --out DIR", wall)) return report(*error);
  }
  const int printed = print(arguments.json ? cloth::validation_json(rows) : cloth::validation_text(rows));
  if (printed != done) return printed;
  if (!is_whole) return interrupted;
  return std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.holds(); }) ? done : differs;
}

}  // namespace

void add_validate(Program& program) {
  auto [command, arguments] = add_command(
      program, "validate",
      "Strips of a material against exact solutions, and how fabrics drape, on four grids", validate);
  CLI::Option* only =
      add_names(command, "--only", arguments.only,
                fmt::format("Only these protocols, separated by commas: {}; without this option all "
                            "but drape, which takes much longer",
                            fmt::join(cloth::validation_protocols(), ", ")),
                cloth::validation_protocols());
  CLI::Option* out = add_path(command, "--out", arguments.folder,
                              "Folder for validation.csv, validation.json and report.html; made if missing");
  CLI::Option* strips =
      add_path(command, "--strips", arguments.strips,
               "Measure nothing; write the strips for other simulators into this folder: what they are made "
               "of, starting meshes and exact curves");
  CLI::Option* scored = add_path(command, "--score", arguments.scored,
                                 "Measure nothing; say how far the strips in this folder, NAME.csv or "
                                 "NAME.obj, are from the exact curves");
  for (CLI::Option* one : {strips, scored}) one->excludes(only)->excludes(out);
  strips->excludes(scored);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
