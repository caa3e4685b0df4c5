#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "integrators/registry.h"
#include "io/csv.h"
#include "io/run_folder.h"
#include "progress.h"
#include "study/extremes_report.h"

namespace clothlab::cli {
namespace {

using json = nlohmann::ordered_json;

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : list + ",") {
    if (c != ',') {
      name += c;
    } else if (!name.empty()) {
      names.push_back(std::move(name));
      name.clear();
    }
  }
  return names;
}

/// Those of `known` that are asked for, in their own order; all if none is asked for. False: one is unknown.
bool choose(const char* option, const std::vector<std::string>& asked, const std::vector<std::string>& known,
            std::vector<std::string>& chosen) {
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    say(fmt::format("{} {}: must be among {}", option, name, fmt::join(known, ", ")));
    return false;
  }
  for (const std::string& name : known)
    if (asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end()) chosen.push_back(name);
  return true;
}

std::optional<cloth::ExtremesTable> asked_table(const ExtremesArguments& arguments) {
  cloth::ExtremesTable table;
  if (!choose("--methods", split(arguments.methods), cloth::integrator_names(), table.methods))
    return std::nullopt;
  std::vector<std::string> all, chosen;
  for (const cloth::ExtremeCase& extreme : cloth::extreme_cases()) all.push_back(extreme.name);
  if (!choose("--cases", split(arguments.cases), all, chosen)) return std::nullopt;
  for (const cloth::ExtremeCase& extreme : cloth::extreme_cases())
    if (std::find(chosen.begin(), chosen.end(), extreme.name) != chosen.end()) table.cases.push_back(extreme);
  return table;
}

/// Runs the cells into `table`; each is on disk before the next begins.
std::optional<cloth::IoError> fill(cloth::ExtremesTable& table, cloth::CsvFile& csv) {
  Progress progress;  // cells take very different times: what is left is a guess
  const double all = static_cast<double>(table.cases.size() * table.methods.size());
  for (const cloth::ExtremeCase& extreme : table.cases) {
    for (const std::string& method : table.methods) {
      progress.show(static_cast<double>(table.cells.size()) / all, extreme.name + ", " + method);
      cloth::ExtremeCell cell = cloth::run_extreme(extreme, method, [] { return !stop_is_requested(); });
      if (stop_is_requested()) return std::nullopt;  // half a cell is none
      table.cells.push_back(std::move(cell));
      if (!csv.is_open()) continue;
      if (auto error = csv.add(cloth::extremes_row(table.cells.back()))) return error;
      if (auto error = csv.flush()) return error;
    }
  }
  return std::nullopt;
}

std::string to_json(const cloth::ExtremesTable& table) {
  json root{{"complete", table.is_complete()},
            {"seed", cloth::extreme_seed},
            {"cases", json::array()},
            {"methods", table.methods},
            {"cells", json::array()}};
  for (const cloth::ExtremeCase& extreme : table.cases)
    root["cases"].push_back({{"name", extreme.name}, {"what", extreme.what}});
  for (const cloth::ExtremeCell& cell : table.cells)
    root["cells"].push_back({{"case", cell.case_name},
                             {"method", cell.method},
                             {"status", cloth::name_of(cell.status)},
                             {"detail", cell.detail},
                             {"time_step_s", cell.time_step},
                             {"steps", cell.steps},
                             {"max_strain", cell.max_strain},
                             {"energy_ratio", cell.energy_ratio},
                             {"wall_s", cell.wall}});
  return root.dump(2) + "\n";
}

std::string command_of(const ExtremesArguments& arguments) {
  std::string command = "clothlab-cli extremes";
  if (!arguments.methods.empty()) command += " --methods " + arguments.methods;
  if (!arguments.cases.empty()) command += " --cases " + arguments.cases;
  return command;
}

}  // namespace

int extremes(const ExtremesArguments& arguments) {
  std::optional<cloth::ExtremesTable> table = asked_table(arguments);
  if (!table) return bad_input;
  listen_for_stop();

  const std::filesystem::path folder = arguments.folder;
  cloth::CsvFile csv;
  if (!folder.empty()) {
    if (const auto error = cloth::make_folder(folder)) return report(*error);
    if (const auto error = csv.open(folder / "extremes.csv", cloth::extremes_columns()))
      return report(*error);
  }
  if (const auto error = fill(*table, csv)) return report(*error);
  if (!folder.empty()) {
    if (const auto error = csv.close()) return report(*error);
    const std::string page = cloth::extremes_html(*table, command_of(arguments));
    if (const auto error = cloth::write_text_file(folder / "report.html", page)) return report(*error);
  }
  const int printed = print(arguments.json       ? to_json(*table)
                            : arguments.markdown ? cloth::extremes_markdown(*table)
                                                 : cloth::extremes_text(*table));
  if (printed != done) return printed;
  return stop_is_requested() ? interrupted : done;
}

}  // namespace clothlab::cli
