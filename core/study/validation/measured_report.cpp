#include "study/validation/measured_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/text_table.h"

namespace cloth {
namespace {

std::string points(double part) {
  return fmt::format("{:.1f} %", 100 * part);
}

std::string band_text(const ValidationRow& row) {
  if (!row.band) return "";
  if (row.band->low == row.band->high) return points(row.band->low);
  return fmt::format("{:g} to {:g} %", 100 * row.band->low, 100 * row.band->high);
}

std::string folds_text(const ValidationRow& row) {
  std::string text;
  for (const ValidationValue& grid : row.grids)
    if (grid.drape) text += fmt::format("{}{}", text.empty() ? "" : ", ", grid.drape->folds);
  return text;
}

/// From the least to the largest of the seeds' rests, and of their folds.
std::string seeds_text(const ValidationRow& row) {
  if (row.seeds.empty()) return "";
  const auto [least, most] = std::minmax_element(
      row.seeds.begin(), row.seeds.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const auto [fewest, all] =
      std::minmax_element(row.seeds.begin(), row.seeds.end(),
                          [](const auto& a, const auto& b) { return a.drape.folds < b.drape.folds; });
  return fmt::format("{} rests: {:.1f} to {:.1f} %, {} to {} folds", row.seeds.size(), 100 * least->value,
                     100 * most->value, fewest->drape.folds, all->drape.folds);
}

/// Of cells that lock on the finest grid, where they are more than one in a hundred.
std::string locking_note(const ValidationRow& row) {
  constexpr double few = 0.01;
  if (row.grids.empty() || !row.grids.back().drape || row.grids.back().drape->cells_above <= few) return "";
  return fmt::format("{:.0f} % of the cells lock", 100 * row.grids.back().drape->cells_above);
}

std::string words_of(const ValidationRow& row) {
  if (!row.failure.empty()) return row.failure;
  const std::string band = in_band_words(row), note = locking_note(row);
  return band + (band.empty() || note.empty() ? "" : "; ") + note;
}

std::vector<int> cells_of(const std::vector<ValidationRow>& rows) {
  std::vector<int> cells;
  for (const ValidationRow& row : rows)
    if (row.is_measured)
      for (const ValidationValue& grid : row.grids) cells.push_back(grid.cells);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::string value_on(const ValidationRow& row, int cells) {
  for (const ValidationValue& grid : row.grids)
    if (grid.cells == cells) return points(grid.value);
  return "";
}

/// The cells of a row's line after its name.
std::vector<std::string> line_of(const ValidationRow& row, const std::vector<int>& cells) {
  std::vector<std::string> line{row.parameter_text, band_text(row)};
  for (const int on : cells) line.push_back(value_on(row, on));
  line.push_back(std::isfinite(row.order()) ? fmt::format("{:.2f}", row.order()) : "");
  line.push_back(folds_text(row));
  line.push_back(seeds_text(row));
  line.push_back(fmt::format("{:.1f} s", row.seconds()));
  line.push_back(words_of(row));
  return line;
}

std::vector<std::string> heads_of(const std::vector<int>& cells) {
  std::vector<std::string> heads{"Material", "Published"};
  for (const int on : cells) heads.push_back(fmt::format("{} cells", on));
  for (const char* head : {"Order", "Folds", "Other rests", "Time", "Verdict"}) heads.emplace_back(head);
  return heads;
}

bool is_number(const std::string& head) {
  return head.ends_with("cells") || head == "Published" || head == "Order" || head == "Time";
}

}  // namespace

std::string in_band_words(const ValidationRow& row) {
  if (!row.band || row.grids.empty()) return "";
  const double value = row.grids.back().value;
  if (row.band->holds(value)) return "within what was published";
  const double beyond = value < row.band->low ? row.band->low - value : value - row.band->high;
  return fmt::format("{:.1f} points {}", 100 * beyond, value < row.band->low ? "below" : "above");
}

std::string measured_text(const std::vector<ValidationRow>& rows) {
  const std::vector<int> cells = cells_of(rows);
  TextTable table{{{"Protocol"}}, {}};
  for (const std::string& head : heads_of(cells)) table.columns.push_back({head, is_number(head)});
  for (const ValidationRow& row : rows) {
    if (!row.is_measured) continue;
    std::vector<std::string> line = line_of(row, cells);
    line.insert(line.begin(), row.protocol);
    table.rows.push_back(std::move(line));
  }
  if (table.rows.empty()) return "";
  return to_text(table) +
         "\nDrape coefficients, elastic: without the hysteresis of bending. Folds are those of each grid. "
         "Other "
         "rests are found from other random disturbances; nothing is promised of what was published.\n";
}

HtmlTable measured_table(const std::string& protocol, const std::vector<ValidationRow>& rows) {
  const std::vector<int> cells = cells_of(rows);
  HtmlTable table;
  for (const std::string& head : heads_of(cells))
    table.columns.push_back({head, is_number(head) ? Align::right : Align::left});
  for (const ValidationRow& row : rows) {
    if (row.protocol != protocol) continue;
    HtmlRow line;
    for (const std::string& text : line_of(row, cells)) line.cells.emplace_back(text);
    table.rows.push_back(std::move(line));
  }
  return table;
}

}  // namespace cloth
