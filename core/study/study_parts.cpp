#include "study/study_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/stability_report.h"
#include "study/study_index.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

constexpr std::size_t most_disagreements = 100;

/// "2-of-3"
bool is_part_name(const std::string& name) {
  const auto of = name.find("-of-");
  if (of == std::string::npos) return false;
  const auto shard =
      shard_from(name.substr(0, of) + "/" + name.substr(of + 4), [](const char*) { return std::string(); });
  return std::holds_alternative<Shard>(shard);
}

/// What measures a limit, in the words of study.json.
std::vector<std::pair<std::string, std::string>> results_of(const MeasuredLimit& limit) {
  return {{"longest_stable_s", csv_number(limit.longest_stable)},
          {"shortest_unstable_s", csv_number(limit.shortest_unstable)},
          {"stable_beyond", limit.stable_beyond ? "true" : "false"}};
}

std::vector<std::pair<std::string, std::string>> results_of(const ReferenceSolution& reference) {
  nlohmann::ordered_json fields;
  visit_reference(JsonFields(fields), reference);
  const nlohmann::ordered_json flat = fields.flatten();
  std::vector<std::pair<std::string, std::string>> results;
  for (const auto& [key, value] : flat.items()) results.emplace_back(key.substr(1), value.dump());
  return results;
}

std::vector<std::pair<std::string, std::string>> results_of(const ValidationRow& row) {
  const std::vector<std::string> columns = table_of(ValidationStudy{}).header;
  std::vector<std::pair<std::string, std::string>> results;
  for (const auto& line : lines_of(row))
    for (std::size_t k = 0; k < line.size(); ++k) results.emplace_back(columns[k], line[k]);
  for (const auto& line : point_lines(row))
    for (const std::string& field : line) results.emplace_back("a point", field);
  return results;
}

}  // namespace

std::filesystem::path part_folder(const std::filesystem::path& folder, const Shard& shard) {
  return folder / "shards" / fmt::format("{}-of-{}", shard.index, shard.count);
}

std::vector<std::filesystem::path> part_folders(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder / "shards", error), end; !error && at != end;
       at.increment(error))
    if (is_part_name(at->path().filename().string())) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  return found;
}

StudyParts::StudyParts(const StudyTable& plan, const std::optional<Shard>& shard)
    : table_(plan), shard_(shard) {
  if (auto* map = std::get_if<StabilityMap>(&table_)) {
    map->complete = false;
    map->methods.clear();
    for (const std::string& method : map->options.methods) map->methods.push_back({method, {}, {}});
  }
  if (auto* study = std::get_if<WorkPrecision>(&table_)) study->stopped = true;
}

void StudyParts::add(const StudyTable& part, const std::string& maker) {
  makers_.push_back(maker);
  std::visit(
      [&](auto& into) {
        using Table = std::remove_reference_t<decltype(into)>;
        join(into, std::get<Table>(part));
      },
      table_);
}

void StudyParts::compare(std::int64_t cell, const std::string& name, const Results& there,
                         const Results& here) {
  if (there == here || disagreements_.size() == most_disagreements) return;
  std::string what = "not alike";
  for (std::size_t k = std::min(there.size(), here.size()); k-- > 0;)
    if (there[k] != here[k])
      what = fmt::format("{} is {} and {}", here[k].first, there[k].second, here[k].second);
  disagreements_.push_back(fmt::format("{}: was made twice, and {}: in {} and in {}", name, what,
                                       makers_[makers_of_[cell]], makers_.back()));
}

/// Both ascending by their numbers.
template <class Cell, class Number, class Name, class Words>
void StudyParts::join_cells(std::vector<Cell>& into, const std::vector<Cell>& from, Number number, Name name,
                            Words words) {
  for (const Cell& cell : from) {
    const std::int64_t at = number(cell);
    if (!wants(at)) continue;
    const auto place = std::ranges::lower_bound(into, at, {}, number);
    if (place != into.end() && number(*place) == at) {
      compare(at, name(cell), words(*place), words(cell));
    } else {
      into.insert(place, cell);
      take(at);
    }
  }
}

void StudyParts::join(ExtremesTable& into, const ExtremesTable& from) {
  join_cells(
      into.cells, from.cells, [&](const ExtremeCell& cell) { return into.number_of(cell); },
      [](const ExtremeCell& cell) { return cell.case_name + ", " + cell.method; },
      [](const ExtremeCell& cell) { return written(cell).results(); });
}

void StudyParts::join(GridConvergence& into, const GridConvergence& from) {
  join_cells(
      into.runs, from.runs,
      [&](const GridRun& run) { return std::ranges::find(into.cells, run.cells) - into.cells.begin(); },
      [](const GridRun& run) { return fmt::format("{} cells", run.cells); },
      [&](const GridRun& run) { return written(run, into).results(); });
}

void StudyParts::join(ValidationStudy& into, const ValidationStudy& from) {
  join_cells(
      into.rows, from.rows, [&](const ValidationRow& row) { return into.number_of(row); },
      [](const ValidationRow& row) { return name_of(row); },
      [](const ValidationRow& row) { return results_of(row); });
}

void StudyParts::join(StabilityMap& into, const StabilityMap& from) {
  const std::size_t columns = into.x_values.size(), count = columns * into.y_values.size();
  for (std::size_t m = 0; m < from.methods.size(); ++m) {
    std::vector<StabilityCell>& cells = into.methods[m].cells;
    const std::string& method = into.methods[m].method;
    for (std::size_t k = 0; k < from.methods[m].cells.size(); ++k) {
      const StabilityCell& cell = from.methods[m].cells[k];
      if (cell.status == CellStatus::not_run || !wants(line_of(into, m, k))) continue;
      for (std::size_t n = cells.size(); n <= k; ++n)
        cells.push_back({.x = into.x_values[n % columns], .y = into.y_values[n / columns]});
      const auto number = static_cast<std::int64_t>(m * count + k);
      if (cells[k].status == CellStatus::not_run) {
        cells[k] = cell;
        take(number);
      } else {
        compare(number, fmt::format("{}, x {:.6g}, y {:.6g}", method, cell.x, cell.y),
                written(cells[k], method).results(), written(cell, method).results());
      }
    }
    join_limits(into, from, m);
  }
}

void StudyParts::join_limits(StabilityMap& into, const StabilityMap& from, std::size_t method) {
  std::vector<MeasuredLimit>& limits = into.methods[method].measured;
  for (const MeasuredLimit& limit : from.methods[method].measured) {
    const std::int64_t line = line_of(into, method, limit);
    if (!wants(line)) continue;
    const auto place = std::ranges::lower_bound(limits, limit.other, {}, &MeasuredLimit::other);
    if (place != limits.end() && place->other == limit.other) {
      compare(-1 - line, fmt::format("{}, limit at {:.6g}", into.methods[method].method, limit.other),
              results_of(*place), results_of(limit));
    } else {
      limits.insert(place, limit);
      take(-1 - line);
    }
  }
}

/// One process makes all of it: its times are only worth something beside each other.
void StudyParts::join(IterationsStudy& into, const IterationsStudy& from) {
  if (into.methods.empty()) into = from;
}

void StudyParts::join_reference(ReferenceSolution& into, const ReferenceSolution& from) {
  constexpr std::int64_t number = -1;
  if (!from.is_known()) return;
  if (into.is_known()) {
    compare(number, "the reference", results_of(into), results_of(from));
    if (into.states.empty()) into.states = from.states;
  } else {
    into = from;
    take(number);
  }
}

void StudyParts::join(WorkPrecision& into, const WorkPrecision& from) {
  constexpr std::int64_t rungs = 64;  // more than there are
  join_reference(into.reference, from.reference);
  for (std::size_t m = 0; m < into.methods.size(); ++m) {
    MethodStudy& method = into.methods[m];
    if (!wants(static_cast<std::int64_t>(m))) continue;
    for (const WorkPrecisionRun& run : from.methods[m].runs) {
      if (run.status == RunStatus::refused) continue;
      const std::int64_t number = static_cast<std::int64_t>(m) * rungs + run.rung + 1;
      const auto place = std::ranges::lower_bound(method.runs, run.rung, {}, &WorkPrecisionRun::rung);
      if (place != method.runs.end() && place->rung == run.rung) {
        compare(number, fmt::format("{}, run {}", method.ladder.facts.name, run.rung),
                written(*place, into, method).results(), written(run, into, method).results());
        if (run.samples.size() > place->samples.size()) place->samples = run.samples;
      } else {
        method.runs.insert(place, run);
        take(number);
      }
    }
  }
  conclude(into);
}

}  // namespace cloth
