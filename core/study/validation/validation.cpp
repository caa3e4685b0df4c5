#include "study/validation/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "study/richardson.h"
#include "study/study_team.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A row of a protocol on all grids; false where it was stopped.
bool measure(const ValidationProtocol& protocol, ValidationRow& row, const StopTest& stop) {
  for (const int cells : protocol.cells) {
    if (!row.failure.empty()) return true;
    const auto start = std::chrono::steady_clock::now();
    ValidationReading reading = protocol.measure(row, cells, stop);
    if (is_to_stop(stop)) return false;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (!reading.failure.empty()) {
      row.failure = fmt::format("{} cells: {}", cells, reading.failure);
      return true;
    }
    const double error = row.is_measured ? nan : reading.value / row.exact - 1;
    row.grids.push_back({cells, reading.value, error, reading.distance, wall.count(), reading.drape});
    if (cells == 20) row.shown = std::move(reading.points);
  }
  return !protocol.measure_seeds || protocol.measure_seeds(row, stop);
}

}  // namespace

const ValidationProtocol* find_protocol(const std::string& name) {
  const auto& all = protocols();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const ValidationProtocol& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

double ValidationRow::order() const {
  if (is_measured) {
    std::vector<GridValue> values;
    for (const ValidationValue& grid : grids) values.push_back({1.0 / grid.cells, grid.value});
    const Richardson found = richardson(values);
    return found.verdict == GridVerdict::converging ? found.order : nan;
  }
  if (grids.size() < 2 || promise == Promise::exact || promise == Promise::error) return nan;
  const bool has_curve = grids.back().distance > 0;
  const auto error = [&](const ValidationValue& grid) { return has_curve ? grid.distance : grid.error; };
  const double coarse = error(grids[grids.size() - 2]), fine = error(grids.back());
  return coarse * fine > 0 ? std::log2(coarse / fine) : nan;
}

double ValidationRow::seconds() const {
  double sum = 0;
  for (const ValidationValue& grid : grids) sum += grid.seconds;
  return sum;
}

bool ValidationRow::holds() const {
  if (!failure.empty()) return false;
  if (promise == Promise::none) return true;
  if (promise == Promise::exact)
    return !grids.empty() && std::all_of(grids.begin(), grids.end(), [](const ValidationValue& value) {
      return std::abs(value.error) <= most_rounding;
    });
  const auto twenty = std::find_if(grids.begin(), grids.end(),
                                   [](const ValidationValue& value) { return value.cells == 20; });
  if (twenty == grids.end() || std::abs(twenty->error) > 0.01) return false;
  return promise == Promise::error || (order() >= 1.8 && order() <= 2.2);
}

std::vector<std::string> exact_protocols() {
  std::vector<std::string> names = validation_protocols();
  for (const ValidationProtocol& of_fabrics : drape_protocols()) std::erase(names, of_fabrics.name);
  return names;
}

std::vector<std::string> validation_protocols() {
  std::vector<std::string> names;
  for (const ValidationProtocol& one : protocols()) names.emplace_back(one.name);
  return names;
}

std::vector<ValidationRow> validation_rows(const std::vector<std::string>& names) {
  std::vector<ValidationRow> rows;
  for (const std::string& name : names)
    if (const ValidationProtocol* protocol = find_protocol(name))
      for (const double parameter : protocol->parameters) {
        ValidationRow row = protocol->expect(parameter);
        row.protocol = name, row.parameter = parameter, row.parameter_name = protocol->parameter_name;
        row.cells = protocol->cells;
        rows.push_back(std::move(row));
      }
  return rows;
}

bool validate(std::vector<ValidationRow> rows, const std::function<void(ValidationRow)>& row,
              const StopTest& stop) {
  for (ValidationRow& expected : rows) {
    if (!measure(*find_protocol(expected.protocol), expected, stop)) return false;
    row(std::move(expected));
  }
  return true;
}

ValidationStudy plan_validation(const ValidationOptions& options) {
  ValidationStudy study;
  for (const std::string& name : options.protocols.empty() ? exact_protocols() : options.protocols)
    if (std::find(study.protocols.begin(), study.protocols.end(), name) == study.protocols.end())
      study.protocols.push_back(name);
  study.expected = validation_rows(study.protocols);
  return study;
}

ValidationStudy run_validation(const ValidationOptions& options) {
  ValidationStudy study = plan_validation(options);
  if (options.earlier) study.rows = options.earlier->rows;
  const auto number_of = [&](const ValidationRow& row) { return study.number_of(row); };
  std::vector<std::int64_t> missing;
  for (std::int64_t number = 0; number < std::ssize(study.expected); ++number)
    if (options.shard.has(number) && !std::ranges::binary_search(study.rows, number, {}, number_of))
      missing.push_back(number);
  const double all = static_cast<double>(study.expected.size());
  double there = all - static_cast<double>(missing.size());
  StudyTeam team({.jobs = options.jobs, .stop = options.stop, .progress = options.progress});
  team.run(missing.size(), [&](std::size_t k) {
    ValidationRow row = study.expected[static_cast<std::size_t>(missing[k])];
    {
      const auto lock = team.alone();
      team.report({there / all, name_of(row)});
    }
    if (!measure(*find_protocol(row.protocol), row, [&] { return team.is_stopped(); })) return false;
    const auto lock = team.alone();
    study.rows.insert(std::ranges::lower_bound(study.rows, missing[k], {}, number_of), std::move(row));
    ++there;
    if (options.partial) options.partial(study);
    return true;
  });
  return study;
}

std::optional<Scene> scene_of(const ValidationRow& row) {
  const ValidationProtocol* protocol = find_protocol(row.protocol);
  if (!protocol || !protocol->strip || row.curve.points.empty() || row.curve.last != StripEnd::free)
    return std::nullopt;
  constexpr int shown_cells = 20;
  Scene scene = strip_scene(protocol->strip(row.parameter, shown_cells), row.curve);
  scene.title = name_of(row);
  scene.integrator = {.method = "implicit-euler", .time_step = 0.005};
  return scene;
}

std::int64_t ValidationStudy::number_of(const ValidationRow& row) const {
  const auto is_it = [&](const ValidationRow& one) { return name_of(one) == name_of(row); };
  return std::find_if(expected.begin(), expected.end(), is_it) - expected.begin();
}

std::string name_of(const ValidationRow& row) {
  if (!row.parameter_text.empty()) return row.protocol + "-" + row.parameter_text;
  return row.parameter_name.empty() ? row.protocol : fmt::format("{}-{:g}", row.protocol, row.parameter);
}

}  // namespace cloth
