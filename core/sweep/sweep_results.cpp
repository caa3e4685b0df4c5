#include "sweep/sweep_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sweep/sweep_points.h"

namespace cloth {
namespace {

constexpr std::size_t most_disagreements = 100;

std::string output_text(double output) {
  return std::isnan(output) ? "" : csv_number(output);
}

/// A row and the attempt that made it.
struct Made {
  const PointRow* row = nullptr;
  const ShardFile* file = nullptr;
};

std::string what_differs(const SweepPlan& plan, const PointRow& a, const PointRow& b) {
  if (a.scene != b.scene) return fmt::format("the scene's hash is {} and {}", a.scene, b.scene);
  if (a.status != b.status) return fmt::format("it is {} and {}", name_of(a.status), name_of(b.status));
  for (std::size_t k = 0; k < plan.outputs.size(); ++k)
    if (output_text(a.outputs[k]) != output_text(b.outputs[k]))
      return fmt::format("{} is {} and {}", plan.outputs[k].name, output_text(a.outputs[k]),
                         output_text(b.outputs[k]));
  if (a.steps != b.steps) return fmt::format("it took {} and {} steps", a.steps, b.steps);
  return "the cause is not the same";
}

SweepDisagreement disagreement(const SweepPlan& plan, const Made& a, const Made& b) {
  return {a.row->point, fmt::format("point {} was made twice, and {}: by {} in {}, and by {} in {}",
                                    a.row->point, what_differs(plan, *a.row, *b.row), a.file->attempt.maker(),
                                    a.file->name, b.file->attempt.maker(), b.file->name)};
}

}  // namespace

SweepResults sweep_results(const SweepFolder& folder, const std::vector<ShardFile>& files) {
  SweepResults results{.points = point_count(folder.plan), .attempts = files.size()};
  std::vector<Made> made;
  for (const ShardFile& file : files) {
    results.damaged += file.damaged;
    for (const PointRow& row : file.rows)
      if (row.point < results.points) made.push_back({&row, &file});
  }
  // Files come by name, and rows of one point stay in that order.
  std::stable_sort(made.begin(), made.end(), [](const Made& a, const Made& b) {
    if (a.row->point != b.row->point) return a.row->point < b.row->point;
    return is_reproducible(a.row->status) && !is_reproducible(b.row->status);
  });
  for (std::size_t k = 0, first = 0; k < made.size(); ++k) {
    if (k > 0 && made[k].row->point == made[first].row->point) {
      if (k == first + 1) ++results.twice;
      if (!agree(*made[first].row, *made[k].row) && results.disagreements.size() < most_disagreements)
        results.disagreements.push_back(disagreement(folder.plan, made[first], made[k]));
      continue;
    }
    first = k;
    results.rows.push_back(*made[k].row);
    results.hosts.push_back(made[k].file->attempt.host);
    ++results.counts[static_cast<std::size_t>(made[k].row->status)];
  }
  return results;
}

std::string missing_shards(const SweepResults& results, std::int64_t count, std::int64_t after,
                           std::int64_t most) {
  std::vector<bool> there(static_cast<std::size_t>(results.points), false);
  for (const PointRow& row : results.rows) there[static_cast<std::size_t>(row.point)] = true;
  const std::int64_t shown = std::clamp<std::int64_t>(count - after, 0, most);
  std::vector<bool> lacks(static_cast<std::size_t>(shown), false);
  for (std::int64_t point = 0; point < results.points; ++point) {
    const std::int64_t k = point % count - after;
    if (k >= 0 && k < shown && !there[static_cast<std::size_t>(point)])
      lacks[static_cast<std::size_t>(k)] = true;
  }
  std::string text;
  for (std::size_t k = 0; k < lacks.size(); ++k) {
    if (!lacks[k]) continue;
    std::size_t last = k;
    while (last + 1 < lacks.size() && lacks[last + 1]) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", k + 1);
    if (last > k) text += fmt::format("-{}", last + 1);
    k = last;
  }
  return text;
}

CsvTable sweep_table(const SweepPlan& plan, const SweepResults& results) {
  const SweepPoints points(plan);
  CsvTable table{.header = {"point"}, .rows = {}};
  for (const std::string& path : paths_of(plan)) table.header.push_back(path);
  for (const RunOutput& output : plan.outputs) table.header.push_back(output.name);
  for (const char* name : {"status", "cause", "steps", "wall_s", "host"}) table.header.emplace_back(name);
  table.rows.reserve(results.rows.size());
  for (std::size_t k = 0; k < results.rows.size(); ++k) {
    const PointRow& row = results.rows[k];
    std::vector<std::string>& fields = table.rows.emplace_back();
    fields.push_back(std::to_string(row.point));
    for (const ParameterValue& value : points.values(row.point)) fields.push_back(csv_value(value));
    for (const double output : row.outputs) fields.push_back(output_text(output));
    fields.insert(fields.end(), {name_of(row.status), row.cause, std::to_string(row.steps),
                                 fmt::format("{:.6g}", row.wall), results.hosts[k]});
  }
  return table;
}

}  // namespace cloth
