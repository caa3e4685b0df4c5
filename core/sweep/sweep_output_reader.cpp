#include "sweep/sweep_output_reader.h"

#include <charconv>
#include <cmath>

#include "io/csv.h"
#include "io/json_reader.h"
#include "io/text_file.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const std::vector<std::string> output_keys{"name",  "of",       "reduce",      "window",
                                           "bound", "measured", "time_column", "value_column"};
constexpr std::size_t most_outputs = 1000;

class SweepOutputReader : public JsonReader<json> {
 public:
  SweepOutputReader(fs::path folder, std::vector<std::string> paths)
      : folder_(std::move(folder)), paths_(std::move(paths)) {}

  std::vector<RunOutput> read(const json& root) {
    std::vector<RunOutput> all;
    const json* outputs = required(root, "", "outputs", "must be given: what is kept of each run");
    if (!outputs || !list(*outputs, "outputs")) return all;
    if (outputs->empty() || outputs->size() > most_outputs) {
      add_problem("outputs", fmt::format("must have 1 to {} entries", most_outputs));
      return all;
    }
    for (std::size_t k = 0; k < outputs->size(); ++k) {
      const std::string path = fmt::format("outputs.{}", k);
      read_output((*outputs)[k], path, all.emplace_back());
      check_name(path, all);
    }
    return all;
  }

 private:
  void read_output(const json& value, const std::string& path, RunOutput& output) {
    if (!object(value, path)) return;
    known_keys(value, path, output_keys);
    if (required(value, path, "of", "must be given: a column of record.csv or a shape measure"))
      text(value, path, "of", output.of);
    output.name = output.of;
    text(value, path, "name", output.name);
    if (const json* reduce = member(value, "reduce")) {
      const auto& names = reduction_names();
      const auto found = std::find(names.begin(), names.end(), *reduce);
      if (found == names.end())
        problem(path + ".reduce", *reduce, fmt::format("must be one of {}", fmt::join(names, ", ")));
      else
        output.reduce = static_cast<Reduction>(found - names.begin());
    }
    read_window(value, path, output);
    if (const json* bound = member(value, "bound"); bound && !has_bound(output.reduce))
      problem(path + ".bound", *bound, "is of first-above, first-below and stays-below");
    else if (has_bound(output.reduce) && required(value, path, "bound", "must be given for this reduction"))
      number(value, path, "bound", output.bound);
    read_measured(value, path, output);
  }

  void read_window(const json& value, const std::string& path, RunOutput& output) {
    const json* window = member(value, "window");
    if (!window) return;
    const std::string at = path + ".window";
    if (output.reduce == Reduction::rms)
      return problem(at, *window, "is not of rms, which takes the times of the measured curve");
    if (!window->is_array() || window->size() != 2 || !(*window)[0].is_number() ||
        !(*window)[1].is_number() || !((*window)[0].get<double>() <= (*window)[1].get<double>()))
      return problem(at, *window, "must be two times in s, the earlier one first");
    output.from = (*window)[0].get<double>();
    output.to = (*window)[1].get<double>();
  }

  void read_measured(const json& value, const std::string& path, RunOutput& output) {
    const json* measured = member(value, "measured");
    const std::string at = path + ".measured";
    if (measured && output.reduce != Reduction::rms) return problem(at, *measured, "is of rms");
    if (output.reduce != Reduction::rms ||
        !required(value, path, "measured", "must be given for rms: a CSV file"))
      return;
    if (measured->is_object()) return read_curve(*measured, at, output.measured);
    if (!measured->is_string()) return problem(at, *measured, "must be the name of a CSV file");
    std::string time_column = "time_s", value_column = output.of, table_text;
    text(value, path, "time_column", time_column);
    text(value, path, "value_column", value_column);
    output.measured.file = measured->get<std::string>();
    const fs::path file = folder_ / output.measured.file;
    if (const auto error = read_text_file(file, table_text)) return problem(at, *measured, error->text());
    read_curve_table(parse_csv(table_text), file.string(), time_column, value_column, output.measured);
  }

  void read_curve_table(const CsvTable& table, const std::string& file, const std::string& time_column,
                        const std::string& value_column, MeasuredCurve& curve) {
    const auto bad = [&](std::size_t line, const std::string& column, const std::string& rule) {
      problems.push_back({column, "", rule, file, static_cast<int>(line), 0});
    };
    std::size_t columns[2];
    for (const std::string* name : {&time_column, &value_column}) {
      const auto found = std::find(table.header.begin(), table.header.end(), *name);
      if (found == table.header.end()) return bad(1, *name, "must be a column of the table");
      columns[name == &value_column] = static_cast<std::size_t>(found - table.header.begin());
    }
    if (table.rows.empty()) return bad(1, "", "has no rows under its header");
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      double entry[2] = {0, 0};
      for (const std::size_t k : {0u, 1u})
        if (columns[k] >= table.rows[r].size() || !read_table_number(table.rows[r][columns[k]], entry[k]))
          return bad(r + 2, k == 0 ? time_column : value_column, "must be a number");
      if (!curve.times.empty() && !(entry[0] > curve.times.back()))
        return bad(r + 2, time_column, "must ascend");
      curve.times.push_back(entry[0]);
      curve.values.push_back(entry[1]);
    }
  }

  /// As write_sweep has it.
  void read_curve(const json& value, const std::string& path, MeasuredCurve& curve) {
    known_keys(value, path, std::vector<std::string>{"file", "times", "values"});
    text(value, path, "file", curve.file);
    for (const char* key : {"times", "values"}) {
      const json* numbers = required(value, path, key);
      if (!numbers || !list(*numbers, joined_path(path, key))) return;
      for (const json& one : *numbers) {
        if (!one.is_number()) return problem(joined_path(path, key), one, "must be numbers");
        (key[0] == 't' ? curve.times : curve.values).push_back(one.get<double>());
      }
    }
    const bool ascends = std::adjacent_find(curve.times.begin(), curve.times.end(),
                                            [](double a, double b) { return !(a < b); }) == curve.times.end();
    if (curve.times.size() != curve.values.size() || curve.times.empty() || !ascends)
      add_problem(path, "must have as many values as times, and times that ascend");
  }

  void check_name(const std::string& path, const std::vector<RunOutput>& outputs) {
    static const std::vector<std::string> taken{"point", "status", "cause", "steps", "wall_s", "host"};
    const std::string& name = outputs.back().name;
    const auto same = std::count_if(outputs.begin(), outputs.end(),
                                    [&](const RunOutput& other) { return other.name == name; });
    if (name.empty())
      add_problem(path, "must have a name");
    else if (same > 1 || std::find(taken.begin(), taken.end(), name) != taken.end() ||
             std::find(paths_.begin(), paths_.end(), name) != paths_.end())
      add_problem(path, fmt::format("has a name that is taken: \"{}\"; give another \"name\"", name));
  }

  fs::path folder_;
  std::vector<std::string> paths_;  ///< columns of what is varied
};

}  // namespace

bool read_table_number(const std::string& text, double& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && !text.empty() && std::isfinite(number);
}

std::vector<RunOutput> read_sweep_outputs(const json& plan, const fs::path& folder,
                                          const std::vector<std::string>& paths,
                                          std::vector<Problem>& problems) {
  SweepOutputReader reader(folder, paths);
  std::vector<RunOutput> outputs = reader.read(plan);
  problems.insert(problems.end(), reader.problems.begin(), reader.problems.end());
  return outputs;
}

}  // namespace cloth
