#include "study/validation/strip_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "io/obj_reader.h"
#include "io/obj_writer.h"
#include "report/text_table.h"
#include "scene/scene_cloth.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

using Eigen::Vector2d;

const char* const end_names[] = {"free", "pinned", "clamped"};

StripCase case_of(const ValidationRow& task) {
  return find_protocol(task.protocol)->strip(task.parameter, bench_cells);
}

/// Cross-sections that an end holds.
int held(StripEnd end) {
  return end == StripEnd::free ? 0 : end == StripEnd::pinned ? 1 : 2;
}

/// "1-6 64-69", counted from 1 as OBJ files do; empty: none.
std::string held_vertices(const ValidationRow& task) {
  const StripCase of = case_of(task);
  const Scene scene = strip_scene(of, task.curve);
  const int across = of.across + 1, all = scene.cloth.columns * across;
  std::string text;
  if (const int first = held(task.curve.first) * across) text = fmt::format("1-{}", first);
  if (const int last = held(task.curve.last) * across)
    text += fmt::format("{}{}-{}", text.empty() ? "" : " ", all - last + 1, all);
  return text;
}

struct NearestPoint {
  double distance = 0, arc = 0;  ///< arc below 0 and above 1: on the straight line behind an end
};

NearestPoint nearest(const StripCurve& curve, const Vector2d& point) {
  const auto& on = curve.points;
  NearestPoint best{std::numeric_limits<double>::infinity(), 0};
  const auto try_segment = [&](const Vector2d& from, const Vector2d& to, double arc, double length) {
    const Vector2d along = to - from;
    const double part = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (point - from - part * along).norm();
    if (distance < best.distance) best = {distance, arc + part * length};
  };
  for (std::size_t k = 0; k + 1 < on.size(); ++k)
    try_segment({on[k].x, on[k].y}, {on[k + 1].x, on[k + 1].y}, on[k].arc, on[k + 1].arc - on[k].arc);
  constexpr double behind = 0.5;
  if (curve.first == StripEnd::clamped)
    try_segment(point_at(curve, -behind), point_at(curve, 0), -behind, behind);
  if (curve.last == StripEnd::clamped)
    try_segment(point_at(curve, 1), point_at(curve, 1 + behind), 1, behind);
  return best;
}

/// Numbers of the columns x and y.
std::optional<PlanePoints> points_of_csv(const std::string& text, std::string& failure) {
  const CsvTable table = parse_csv(text);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(table.header.begin(), table.header.end(), name) -
                                    table.header.begin());
  };
  const std::size_t columns[] = {column("x"), column("y")};
  PlanePoints points;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    Vector2d point;
    for (int k = 0; k < 2; ++k) {
      if (columns[k] == table.header.size()) {
        failure = fmt::format("has no column \"{}\"", k == 0 ? "x" : "y");
        return {};
      }
      const auto& fields = table.rows[row];
      const std::string field = columns[k] < fields.size() ? fields[columns[k]] : "";
      double value = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
      if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
        failure = fmt::format("line {}: \"{}\" is not a number", row + 2, field);
        return {};
      }
      point[k] = value / strip_length;
    }
    points.push_back(point);
  }
  return points;
}

std::optional<PlanePoints> points_of_obj(const std::string& text, const std::string& place,
                                         std::string& failure) {
  const ObjReading reading = parse_obj(text, place);
  if (!reading.mesh) {
    failure = reading.problem;
    return {};
  }
  PlanePoints points;
  for (const Vec3& vertex : reading.mesh->vertices)
    points.emplace_back(vertex.x() / strip_length, vertex.y() / strip_length);
  return points;
}

StripScore score_text_of(const ValidationRow& task, const std::filesystem::path& path,
                         const std::string& text) {
  std::string failure;
  const auto points = path.extension() == ".obj" ? points_of_obj(text, path.filename().string(), failure)
                                                 : points_of_csv(text, failure);
  if (points) return score_strip(task, *points);
  return {.name = name_of(task), .exact = task.exact, .failure = failure};
}

}  // namespace

std::vector<ValidationRow> strip_tasks() {
  std::vector<ValidationRow> tasks = validation_rows(exact_protocols());
  std::erase_if(tasks, [](const ValidationRow& row) { return row.curve.points.empty(); });
  return tasks;
}

std::string strips_csv(const std::vector<ValidationRow>& tasks) {
  CsvTable table{{"name", "parameter", "length_m", "areal_density_kg_m2", "gravity_m_s2", "bending_Nm",
                  "first_end", "last_end", "held_vertices", "quantity", "exact"},
                 {}};
  for (const ValidationRow& task : tasks) {
    const Scene scene = strip_scene(case_of(task), task.curve);
    const double gravity = case_of(task).load < 1e-3 ? 0 : gravity_of(scene).norm();
    const bool has_value = find_protocol(task.protocol)->value;
    table.rows.push_back({name_of(task), fmt::format("{} {:g}", task.parameter_name, task.parameter),
                          csv_number(strip_length), csv_number(scene.material->areal_density),
                          csv_number(gravity), csv_number(scene.material->bending_warp),
                          end_names[static_cast<int>(task.curve.first)],
                          end_names[static_cast<int>(task.curve.last)], held_vertices(task),
                          has_value ? task.quantity : "", has_value ? csv_number(task.exact) : ""});
  }
  return csv_text(table, "\r\n");
}

std::string strips_index(const std::vector<FileDigest>& files) {
  const nlohmann::ordered_json root{
      {"program", "clothlab"}, {"kind", "strips"}, {"files", digests_json(files)}};
  return root.dump(2) + "\n";
}

std::string starting_obj(const ValidationRow& task) {
  const Scene scene = strip_scene(case_of(task), task.curve);
  const ClothSystem system = make_cloth(scene);
  const Vec3Field start = start_of_strip(case_of(task), task.curve, system);
  TriangleMesh mesh;
  for (int column = 0; column < system.columns; ++column)
    for (int row = 0; row < system.rows; ++row) {
      mesh.vertices.push_back(start[static_cast<std::size_t>(system.index(row, column))]);
      if (row == 0 || column == 0) continue;
      const int here = static_cast<int>(mesh.vertices.size()) - 1, before = here - system.rows;
      mesh.triangles.push_back({before - 1, here - 1, here});
      mesh.triangles.push_back({before - 1, here, before});
    }
  return obj_text(mesh, name_of(task));
}

StripScore score_strip(const ValidationRow& task, const std::vector<Vector2d>& points) {
  StripScore score{.name = name_of(task), .exact = task.exact};
  std::vector<std::pair<double, Vector2d>> along;
  for (const Vector2d& point : points) {
    const NearestPoint on = nearest(task.curve, point);
    if (on.arc < 0 || on.arc > 1) continue;
    along.emplace_back(on.arc, point);
    score.rms += on.distance * on.distance, score.largest = std::max(score.largest, on.distance);
  }
  std::sort(along.begin(), along.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  score.points = along.size();
  score.rms = std::sqrt(score.rms / std::max(1.0, static_cast<double>(along.size())));
  constexpr double longest_gap = 0.2;
  double before = 0, gap = 0;
  for (const auto& [arc, point] : along) gap = std::max(gap, arc - before), before = arc;
  gap = std::max(gap, 1 - before);
  if (gap > longest_gap) {
    score.failure = fmt::format(
        "leaves {:.0f} % of the curve without a point: x and y are m, the first end is at 0, 0 and gravity "
        "points along -y",
        100 * gap);
    return score;
  }
  if (const auto value = find_protocol(task.protocol)->value) {
    PlanePoints sorted;
    for (const auto& [arc, point] : along) sorted.push_back(point);
    score.value = value(sorted);
  }
  return score;
}

std::optional<IoError> score_folder(const std::filesystem::path& folder, std::vector<StripScore>& scores) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return IoError{folder, "is not a folder", true};
  for (const ValidationRow& task : strip_tasks())
    for (const char* extension : {".csv", ".obj"}) {
      const std::filesystem::path path = folder / (name_of(task) + extension);
      if (!std::filesystem::exists(path, error)) continue;
      std::string text;
      if (auto failed = read_text_file(path, text)) return failed;
      scores.push_back(score_text_of(task, path, text));
    }
  if (scores.empty())
    return IoError{
        folder, "has no file with the name of a strip, such as cantilever-5.csv or heart-loop-5.obj", true};
  return std::nullopt;
}

std::string score_text(const std::vector<StripScore>& scores) {
  TextTable table{{{"Strip"},
                   {"Points", true},
                   {"RMS distance", true},
                   {"Largest", true},
                   {"Value", true},
                   {"Exact", true},
                   {"Error", true},
                   {"Remark"}},
                  {}};
  for (const StripScore& score : scores) {
    std::vector<std::string> row{score.name, std::to_string(score.points), "", "", "", "", "", score.failure};
    if (score.failure.empty()) {
      row[2] = fmt::format("{:.3g} %", 100 * score.rms),
      row[3] = fmt::format("{:.3g} %", 100 * score.largest);
      if (score.value) {
        row[4] = fmt::format("{:.6g}", *score.value), row[5] = fmt::format("{:.6g}", score.exact);
        row[6] = fmt::format("{:.3g} %", 100 * (*score.value / score.exact - 1));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return to_text(table) +
         "\nDistances are from the points to the exact curve, in per cent of the strip's length.\n";
}

std::string score_json(const std::vector<StripScore>& scores) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const StripScore& score : scores) {
    Json entry{{"name", score.name}, {"points", score.points}};
    if (score.failure.empty()) {
      entry["rms_distance"] = score.rms, entry["largest_distance"] = score.largest;
      if (score.value)
        entry.update({{"value", *score.value},
                      {"exact", score.exact},
                      {"relative_error", *score.value / score.exact - 1}});
    } else {
      entry["failure"] = score.failure;
    }
    list.push_back(std::move(entry));
  }
  return Json{{"strips", std::move(list)}}.dump(2) + "\n";
}

}  // namespace cloth
