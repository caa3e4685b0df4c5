#include "study/validation/measured_points.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/table_reader.h"
#include "io/text_file.h"
#include "study/run_output.h"

namespace cloth {
namespace {

constexpr std::array axis_names{"x", "y", "z"};

/// What a line runs along, and which it is of its kind: first, middle or last.
struct LinePlace {
  bool is_row = true;
  int which = 0;
};

LinePlace place_of(const std::string& line) {
  const auto& lines = measured_lines();
  const auto at = static_cast<int>(std::find(lines.begin(), lines.end(), line) - lines.begin());
  return {at < 3, at % 3};
}

void read_profile(TableReader& table, MeasuredData& data) {
  data.kind = MeasuredKind::profile;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!table.has(axis_names[axis])) continue;
    data.has_axis[axis] = true;
    const std::vector<double> numbers = table.column(axis_names[axis]);
    data.points.resize(std::max(data.points.size(), numbers.size()), Vec3::Zero());
    for (std::size_t k = 0; k < numbers.size(); ++k)
      data.points[k][static_cast<Eigen::Index>(axis)] = numbers[k];
  }
  if (std::count(data.has_axis.begin(), data.has_axis.end(), true) < 2)
    table.add("", "",
              "must have two of the columns x, y and z at least, in m: a line of particles is a profile");
}

void read_quantity(TableReader& table, const Scene& scene, MeasuredData& data) {
  if (!table.has("value")) return table.add("", "", "must have a column value, and time (s) for a history");
  data.values = table.column("value");
  if (!table.has("time")) {
    data.kind = MeasuredKind::value;
    if (data.values.size() > 1)
      table.add("value", "", "must be one number: several need a column time, in s", 1);
    return;
  }
  data.kind = MeasuredKind::history;
  data.times = table.column("time");
  for (std::size_t k = 0; k < data.times.size(); ++k) {
    const double time = data.times[k];
    if (time < 0 || time > scene.duration * (1 + 1e-9))
      return table.add("time", fmt::format("{} s", time),
                       fmt::format("must be from 0 to the scene's duration, {} s", scene.duration), k);
    if (k > 0 && time <= data.times[k - 1])
      return table.add("time", fmt::format("{} s", time), "must be after the one before", k);
  }
  const auto is_zero = [](double value) { return value == 0; };
  if (std::all_of(data.values.begin(), data.values.end(), is_zero))
    table.add("value", "", "must not be 0 throughout: errors are parts of the largest");
}

void check_value(TableReader& table, const MeasuredData& data) {
  if (data.kind == MeasuredKind::value && !data.values.empty() && data.values.front() == 0)
    table.add("value", "0", "must not be 0: the error is a part of it", 0);
}

/// What a rest leaves out, or what it needs.
std::optional<std::string> broken_rest_rule(const Scene& scene) {
  const bool has_wind = scene.air && scene.air->wind.norm() > 0;
  const char* beside = !scene.obstacles.empty() ? "obstacles"
                       : scene.self_contact     ? "self_contact"
                       : scene.deformation      ? "a deformation rate"
                       : has_wind               ? "wind"
                                                : nullptr;
  if (beside) return fmt::format("must be end: the scene has {}, which a rest leaves out", beside);
  if (!(gravity_of(scene).norm() > 0)) return "must be end: a rest needs gravity";
  return std::nullopt;
}

std::vector<Problem> problems_of_block(const Scene& scene) {
  const MeasuredPoints& measured = *scene.measured;
  std::vector<Problem> problems;
  if (measured.state == "rest")
    if (const auto rule = broken_rest_rule(scene)) problems.push_back({"measured.state", "rest", *rule});
  if (is_line(measured.output)) {
    if (scene.cloth.is_mesh())
      problems.push_back(
          {"measured.output", measured.output, "is a line of a grid, and the cloth is a mesh"});
  } else if (scene.cloth.is_mesh()) {
    problems.push_back(
        {"cloth.mesh", '"' + scene.cloth.mesh.file + '"', "has no measured points: a grid has"});
  } else {
    const std::vector<std::string> known = output_sources(scene);
    if (std::find(known.begin(), known.end(), parse_output(measured.output).of) == known.end())
      problems.push_back({"measured.output", measured.output,
                          fmt::format("must be {}; or one of {}, alone or with :max, :min or :mean",
                                      fmt::join(measured_lines(), ", "), fmt::join(known, ", "))});
  }
  return problems;
}

}  // namespace

const std::vector<std::string>& measured_lines() {
  static const std::vector<std::string> lines{"top-row",     "middle-row",    "bottom-row",
                                              "left-column", "middle-column", "right-column"};
  return lines;
}

bool is_line(const std::string& output) {
  return std::find(measured_lines().begin(), measured_lines().end(), output) != measured_lines().end();
}

std::filesystem::path measured_path(const Scene& scene) {
  return std::filesystem::path(scene.folder.path) / scene.measured->file;
}

MeasuredReading read_measured(const Scene& scene) {
  const MeasuredPoints& measured = *scene.measured;
  MeasuredReading reading{{}, problems_of_block(scene)};
  if (!reading.problems.empty()) return reading;
  const std::filesystem::path path = measured_path(scene);
  std::string text;
  if (const auto error = read_text_file(path, text)) {
    reading.problems.push_back({"measured.file", '"' + measured.file + '"',
                                "must be a CSV file, as seen from the scene's folder: " + error->text()});
    return reading;
  }
  CsvTable csv = parse_csv(text);
  while (!csv.rows.empty() && csv.rows.back() == std::vector<std::string>{""}) csv.rows.pop_back();
  TableReader table(csv, path.string(), reading.problems);
  if (!table.is_whole()) return reading;
  if (is_line(measured.output))
    read_profile(table, reading.data);
  else
    read_quantity(table, scene, reading.data);
  check_value(table, reading.data);
  const bool is_history = reading.data.kind == MeasuredKind::history;
  if (is_history && (measured.state == "rest" || parse_output(measured.output).reduce != Reduction::final_value))
    reading.problems.push_back({"measured.output", measured.output,
                                "of a file with times must be the quantity alone, and the state end"});
  return reading;
}

std::vector<Vec3> points_of_line(const std::string& line, const ClothSystem& system,
                                 const Vec3Field& position) {
  const LinePlace place = place_of(line);
  const int across = place.is_row ? system.rows : system.columns;
  const int along = place.is_row ? system.columns : system.rows;
  const int before = place.which * (across - 1) / 2, after = (place.which * (across - 1) + 1) / 2;
  const auto at = [&](int which, int k) {
    const int particle = place.is_row ? system.index(which, k) : system.index(k, which);
    return position[static_cast<std::size_t>(particle)];
  };
  std::vector<Vec3> points;
  for (int k = 0; k < along; ++k) points.push_back((at(before, k) + at(after, k)) / 2);
  return points;
}

double length_of_line(const std::string& line, const ClothSheet& cloth) {
  return place_of(line).is_row ? cloth.width : cloth.height;
}

}  // namespace cloth
