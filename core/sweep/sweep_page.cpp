#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html_page.h"
#include "report/svg.h"
#include "scene/scene_json.h"
#include "sweep/sweep_account.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_report.h"

namespace cloth {
namespace {

constexpr std::size_t most_failures = 100;

HtmlTable status_table(const SweepResults& results) {
  HtmlTable table{
      .caption = "How the points ended", .columns = {{"status"}, {"points", Align::right}}, .rows = {}};
  const auto add = [&](const std::string& name, std::int64_t count) {
    if (count > 0) table.rows.push_back({.cells = {HtmlCell(name), HtmlCell(std::to_string(count))}});
  };
  for (int k = 0; k < point_statuses; ++k)
    add(name_of(static_cast<PointStatus>(k)), results.counts[static_cast<std::size_t>(k)]);
  add("missing", results.missing());
  return table;
}

HtmlTable output_table(const SweepPlan& plan, const SweepResults& results) {
  HtmlTable table{.caption = "Outputs",
                  .columns = {{"output"},
                              {"of"},
                              {"reduction"},
                              {"values", Align::right},
                              {"least", Align::right},
                              {"largest", Align::right}},
                  .rows = {}};
  for (std::size_t k = 0; k < plan.outputs.size(); ++k) {
    double low = infinity, high = -infinity;
    std::int64_t count = 0;
    for (const PointRow& row : results.rows)
      if (std::isfinite(row.outputs[k])) {
        low = std::min(low, row.outputs[k]);
        high = std::max(high, row.outputs[k]);
        ++count;
      }
    HtmlRow row;
    row.cells = {HtmlCell(plan.outputs[k].name), HtmlCell(html_code(plan.outputs[k].of)),
                 HtmlCell(name_of(plan.outputs[k].reduce)), HtmlCell(std::to_string(count))};
    if (count > 0) {
      row.cells.emplace_back(html_number(low, 4));
      row.cells.emplace_back(html_number(high, 4));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string shown(const ParameterValue& value) {
  const auto number = number_of(value);
  return number ? short_number(*number, 5) : csv_value(value);
}

HtmlTable failure_table(const SweepPlan& plan, const SweepResults& results) {
  const SweepPoints points(plan);
  HtmlTable table{.caption = "Points that failed", .columns = {{"point", Align::right}}, .rows = {}};
  for (const std::string& path : paths_of(plan)) table.columns.push_back({html_code(path), Align::right});
  table.columns.push_back({"status"});
  table.columns.push_back({"cause"});
  for (const PointRow& row : results.rows) {
    if (row.status == PointStatus::finished) continue;
    if (table.rows.size() == most_failures) break;
    HtmlRow& entry = table.rows.emplace_back();
    entry.cells.emplace_back(std::to_string(row.point));
    for (const ParameterValue& value : points.values(row.point)) entry.cells.emplace_back(shown(value));
    entry.cells.emplace_back(name_of(row.status));
    entry.cells.emplace_back(row.cause);
  }
  return table;
}

std::string hosts_text(const SweepResults& results) {
  std::vector<std::string> hosts = results.hosts;
  std::sort(hosts.begin(), hosts.end());
  const auto count = std::unique(hosts.begin(), hosts.end()) - hosts.begin();
  return fmt::format("{} by {} attempts", count, results.attempts);
}

}  // namespace

std::string sweep_page(const SweepFolder& folder, const SweepResults& results,
                       const std::vector<SweepPlot>& plots) {
  const SweepPlan& plan = folder.plan;
  HtmlPage page(
      "Sweep: " + (plan.title.empty() ? plan.scene.title : plan.title),
      "One scene at many points of its parameters; every row is in " + html_code("sweep.csv") + ".");
  if (results.missing() > 0)
    page.notice(fmt::format("{} of {} points are missing.", results.missing(), results.points),
                Verdict::warn);
  for (const SweepPlot& plot : plots) page.figure(plot.svg, plot.caption);
  if (has_points(plan)) add_points(points_account(folder, results), page);
  if (plots.empty() && !has_points(plan))
    page.paragraph(
        "There is no picture: curves and maps are drawn of parameters that are numbers, and of at most "
        "20,000 points.");
  page.heading("Points");
  page.table(status_table(results));
  page.table(output_table(plan, results));
  if (const HtmlTable failures = failure_table(plan, results); !failures.rows.empty()) {
    page.table(failures);
    if (failures.rows.size() == most_failures) page.paragraph("Further ones are in sweep.csv.");
  }
  page.heading("How it was made");
  double wall = 0;
  for (const PointRow& row : results.rows) wall += row.wall;
  page.facts({{"scene", plan.scene.title},
              {"plan", html_code(folder.hash)},
              {"design", name_of(plan.design)},
              {"Clothlab", folder.version},
              {"instruction set", folder.instruction_set},
              {"machines", hosts_text(results)},
              {"points made twice, with the same bits", std::to_string(results.twice)},
              {"time of all points", fmt::format("{:.4g} s", wall)}});
  page.folded("The plan", write_sweep(plan));
  return page.to_html();
}

}  // namespace cloth
