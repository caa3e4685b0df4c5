#include "study/validation/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "report/html_page.h"
#include "report/text_table.h"
#include "study/validation/measured_report.h"

namespace cloth {
namespace {

constexpr const char* promise_names[] = {"none", "error", "second order", "exact"};

std::string parameter_of(const ValidationRow& row) {
  if (!row.parameter_text.empty()) return row.parameter_text;
  return row.parameter_name.empty() ? "" : fmt::format("{} {:g}", row.parameter_name, row.parameter);
}

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string order_of(const ValidationRow& row) {
  return std::isfinite(row.order()) ? fmt::format("{:.2f}", row.order()) : "";
}

std::string verdict_of(const ValidationRow& row) {
  if (!row.failure.empty()) return row.failure;
  if (row.band) return in_band_words(row);
  if (row.promise == Promise::none) return "";
  return row.holds() ? "holds" : "does not hold";
}

std::vector<std::string> protocols_of(const std::vector<ValidationRow>& rows) {
  std::vector<std::string> names;
  for (const ValidationRow& row : rows)
    if (names.empty() || names.back() != row.protocol) names.push_back(row.protocol);
  return names;
}

const ValidationRow& first_of(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const ValidationRow& row) { return row.protocol == protocol; });
}

HtmlTable table_of(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  HtmlTable table;
  for (const char* head : {"Parameter", "Exact"}) table.columns.push_back({head, Align::right});
  for (const int cells : validation_cells)
    table.columns.push_back({fmt::format("Error, {} cells", cells), Align::right});
  for (const char* head : {"Order", "From the curve, 20 cells"})
    table.columns.push_back({head, Align::right});
  const bool is_exact = first_of(protocol, rows).promise == Promise::exact;
  const bool has_order = first_of(protocol, rows).promise != Promise::error;
  table.columns.push_back({is_exact    ? "Exact but for rounding"
                           : has_order ? "Within 1 % at 20 cells, order 2"
                                       : "Within 1 % at 20 cells"});
  for (const ValidationRow& row : rows) {
    if (row.protocol != protocol) continue;
    HtmlRow line{{parameter_of(row), fmt::format("{:.7g}", row.exact)}};
    for (std::size_t k = 0; k < validation_cells.size(); ++k)
      line.cells.emplace_back(k < row.grids.size() ? percent(row.grids[k].error) : "");
    const bool has_distance = row.grids.size() > 1 && row.grids[1].distance > 0;
    line.cells.emplace_back(order_of(row));
    line.cells.emplace_back(has_distance ? fmt::format("{:.2g} of the length", row.grids[1].distance) : "");
    line.cells.push_back(
        {row.promise != Promise::none || !row.failure.empty() ? verdict_of(row) : "not promised",
         row.holds() ? row.promise != Promise::none ? Verdict::good : Verdict::none : Verdict::bad});
    table.rows.push_back(std::move(line));
  }
  return table;
}

std::string exact_text(const std::vector<ValidationRow>& rows) {
  TextTable table{{{"Protocol"}, {"Parameter"}, {"Exact", true}}, {}};
  for (const int cells : validation_cells) table.columns.push_back({fmt::format("{} cells", cells), true});
  table.columns.push_back({"Order", true});
  table.columns.push_back({"Time", true});
  table.columns.push_back({"Verdict"});
  for (const ValidationRow& row : rows) {
    if (row.is_measured) continue;
    std::vector<std::string> line{row.protocol, parameter_of(row), fmt::format("{:.7g}", row.exact)};
    for (std::size_t k = 0; k < validation_cells.size(); ++k)
      line.push_back(k < row.grids.size() ? percent(row.grids[k].error) : "");
    line.push_back(order_of(row));
    line.push_back(row.seconds() > 0 ? fmt::format("{:.1f} s", row.seconds()) : "");  // a folder has none
    line.push_back(verdict_of(row));
    table.rows.push_back(std::move(line));
  }
  if (table.rows.empty()) return "";
  return to_text(table) +
         "\nErrors are relative to the exact value. Holds: at most 1 % with 20 cells, and an order from 1.8 "
         "to 2.2 over the finest two grids, of the distance from the exact curve where there is one; "
         "lateral buckling and bias extension have no order, the picture frame has no error but "
         "rounding's.\n";
}

}  // namespace

std::string validation_text(const std::vector<ValidationRow>& rows) {
  const std::string exact = exact_text(rows), measured = measured_text(rows);
  return exact + (exact.empty() || measured.empty() ? "" : "\n") + measured;
}

namespace {

using Json = nlohmann::ordered_json;

Json drape_json(const DrapeFacts& drape) {
  return {{"folds", drape.folds}, {"amplitude", drape.amplitude}, {"cells_that_lock", drape.cells_above}};
}

Json grid_json(const ValidationRow& row, const ValidationValue& grid) {
  Json one{{"cells", grid.cells}, {"value", grid.value}};
  if (!row.is_measured) one["relative_error"] = grid.error;
  if (grid.distance > 0) one["rms_distance"] = grid.distance;
  if (grid.drape) one.update(drape_json(*grid.drape));
  return one;
}

/// What stands in place of an exact value where there is none.
void put_measured(const ValidationRow& row, Json& entry) {
  if (row.band) entry["published"] = {{"low", row.band->low}, {"high", row.band->high}};
  Json seeds = Json::array();
  for (const SeedValue& one : row.seeds) {
    Json seed{{"seed", one.seed}, {"value", one.value}};
    seed.update(drape_json(one.drape));
    seeds.push_back(std::move(seed));
  }
  entry["seeds"] = {{"cells", row.seed_cells}, {"values", std::move(seeds)}};
}

Json row_json(const ValidationRow& row) {
  Json entry{{"protocol", row.protocol}};
  if (!row.parameter_text.empty())
    entry[row.parameter_name] = row.parameter_text;
  else if (!row.parameter_name.empty())
    entry[row.parameter_name] = row.parameter;
  entry.update({{"quantity", row.quantity}, {"source", row.source}, {"method", row.method}});
  if (row.is_measured)
    put_measured(row, entry);
  else
    entry["exact"] = row.exact;
  entry["grids"] = Json::array();
  for (const ValidationValue& grid : row.grids) entry["grids"].push_back(grid_json(row, grid));
  entry["order"] = std::isfinite(row.order()) ? Json(row.order()) : Json(nullptr);
  entry["promise"] = promise_names[static_cast<std::size_t>(row.promise)];
  entry["holds"] = row.holds();
  if (!row.failure.empty()) entry["failure"] = row.failure;
  return entry;
}

}  // namespace

std::string validation_json(const std::vector<ValidationRow>& rows) {
  Json list = Json::array();
  for (const ValidationRow& row : rows) list.push_back(row_json(row));
  return Json{{"program", "clothlab"}, {"kind", "validation"}, {"rows", std::move(list)}}.dump(2) + "\n";
}

std::string validation_page(const std::vector<ValidationRow>& rows, const std::string& command, double wall) {
  HtmlPage page("Materials against exact solutions",
                "Strips of a material at rest, the loads at which they buckle and the forces with which they "
                "push, each on four grids, beside the exact value.");
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const auto& row) { return !row.holds(); });
  page.notice(failed == 0 ? fmt::format("All that is promised holds, in {} rows.", rows.size())
                          : fmt::format("{} of {} rows do not hold what is promised.", failed, rows.size()),
              failed == 0 ? Verdict::good : Verdict::bad);
  for (const std::string& protocol : protocols_of(rows)) {
    const ValidationRow& first = first_of(protocol, rows);
    page.heading(protocol);
    page.paragraph(fmt::format("{}. {}. Taken {}.", first.quantity, first.source, first.method));
    if (first.is_measured) {
      page.table(measured_table(protocol, rows));
      continue;
    }
    page.table(table_of(protocol, rows));
    page.figure(
        to_svg(error_plot(protocol, rows)),
        first.promise == Promise::exact ? "Errors: what rounding leaves." : "Errors: the slope is the order.",
        command);
    page.begin_details("Curves");
    for (const ValidationRow& row : rows)
      if (row.protocol == protocol && !row.shown.empty())
        page.figure(to_svg(curve_plot(row)), "The exact curve, and the particles of a strip of 20 cells.",
                    command);
    page.end_details();
  }
  page.heading("How it was made");
  page.facts({{"Strips",
               "0.1 m long, 0.2 kg/m2, two cells wide; stretch 10^6 times the bending over the "
               "length squared, so that it is seen in none of these errors"},
              {"Order",
               "from 40 and 80 cells: of the distance from the exact curve, root mean square, or of the "
               "error where there is no curve"},
              {"Time taken", fmt::format("{:.3g} s", wall)}});
  page.machine_facts();
  return page.to_html();
}

std::string study_page(const ValidationStudy& study, const std::string& command, double wall) {
  return validation_page(study.rows, command, wall);
}

std::string study_text(const ValidationStudy& study) {
  return validation_text(study.rows);
}

std::string study_json(const ValidationStudy& study) {
  return validation_json(study.rows);
}

}  // namespace cloth
