#include "charts/chart_record.h"

#include <QObject>
#include <QRegularExpression>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "params/quantity.h"
#include "scene/probe.h"

namespace clothlab {

void ChartRecord::append(std::span<const ChartSample> batch) {
  for (const ChartSample& s : batch) {
    if (s.is_cut) {
      samples.drop_after(s.time_s);
      draws.drop_after(s.time_s);
      continue;
    }
    if (!samples.empty() && s.time_s < samples.last_time()) clear();
    if (s.probe_columns ? *s.probe_columns != probes : !probes.empty())
      set_probes(s.probe_columns ? *s.probe_columns : std::vector<std::string>());
    std::vector<double> row{s.kinetic_J, s.elastic_J, s.gravity_J, s.total_J, s.max_strain, s.step_ms};
    row.insert(row.end(), s.probes.begin(), s.probes.end());
    samples.append(s.time_s, row);
    if (std::isfinite(s.draw_ms)) append_draw_time(s.time_s, s.draw_ms);
  }
}

void ChartRecord::set_probes(const std::vector<std::string>& columns) {
  std::vector<std::optional<std::size_t>> before;  // where the samples have them now
  for (std::size_t k = 0; k < sample_columns; ++k) before.emplace_back(k);
  for (const std::string& column : columns) {
    const auto known = std::find(probes.begin(), probes.end(), column);
    before.emplace_back();
    if (known != probes.end())
      before.back() = sample_columns + static_cast<std::size_t>(known - probes.begin());
  }
  SampleSeries moved(before.size());
  std::vector<double> values(before.size());
  for (std::size_t row = 0; row < samples.size(); ++row) {
    for (std::size_t k = 0; k < before.size(); ++k)
      values[k] = before[k] ? samples.value(*before[k], row) : no_value;
    moved.append(samples.time(row), values);
  }
  samples = std::move(moved);
  probes = columns;
}

void ChartRecord::append_draw_time(double time_s, double milliseconds) {
  draws.drop_after(time_s);  // a run that is gone through again draws anew
  draws.append(time_s, std::array{milliseconds});
}

void ChartRecord::clear() {
  samples.clear();
  draws.clear();
}

Range ChartRecord::times() const {
  if (!samples.empty()) return {samples.first_time(), samples.last_time()};
  if (!draws.empty()) return {draws.first_time(), draws.last_time()};
  return {0, 0};
}

std::optional<std::size_t> ChartRecord::measured_column() const {
  if (!measured) return std::nullopt;
  for (const auto& [name, column] : {std::pair{"kinetic_J", kinetic},
                                     {"elastic_J", elastic},
                                     {"gravity_J", gravity},
                                     {"total_J", total},
                                     {"max_strain", strain}})
    if (measured->column == name) return column;
  const auto probe = std::find(probes.begin(), probes.end(), measured->column);
  if (probe == probes.end()) return std::nullopt;
  return sample_columns + static_cast<std::size_t>(probe - probes.begin());
}

const std::vector<ChartSpec>& chart_specs() {
  using M = Marker;
  static const std::vector<ChartSpec> specs{
      {"energy",
       "Energy (J)",
       "J",
       false,
       {{"Kinetic", Source::samples, kinetic, 1, {&Theme::kinetic, M::circle}},
        {"Elastic", Source::samples, elastic, 1, {&Theme::elastic, M::square}},
        {"Gravity", Source::samples, gravity, 1, {&Theme::gravity, M::triangle}},
        {"Total", Source::samples, total, 1, {&Theme::total, M::none, 2.2}}},
       false},
      {"strain",
       "Maximum strain (%)",
       "%",
       true,
       {{"Strain", Source::samples, strain, 100, {&Theme::strain, M::none, 1.8}}},
       true},
      {"frame_time",
       "Frame time (ms)",
       "ms",
       true,
       {{"Simulation step", Source::samples, step_time, 1, {&Theme::step_time, M::none}},
        {"Drawing", Source::draws, 0, 1, {&Theme::draw_time, M::circle}}},
       false}};
  return specs;
}

ProbeAxis probe_axis(const std::string& column, const std::string& unit) {
  if (column.ends_with(".strain")) return {"%", QObject::tr("Probes: strain (%)"), "probes_strain", 100};
  if (unit == "rad") return {"°", QObject::tr("Probes: angle (°)"), "probes_angle", 180 / std::numbers::pi};
  if (unit.empty()) return {"", QObject::tr("Probes: pure numbers"), "probes_numbers", 1};
  const QString shown = QString::fromStdString(cloth::shown_unit(unit));
  QString key = "probes_" + QString::fromStdString(unit);
  key.replace(QRegularExpression("[^a-z0-9]+"), "_");
  return {QString::fromStdString(unit), QObject::tr("Probes (%1)").arg(shown), key, 1};
}

namespace {

CurveStyle probe_style(std::size_t curve) {
  static constexpr QColor Theme::*colours[] = {&Theme::kinetic, &Theme::elastic,   &Theme::gravity,
                                               &Theme::strain,  &Theme::step_time, &Theme::total};
  static constexpr Marker markers[] = {Marker::circle, Marker::square, Marker::triangle, Marker::diamond};
  return {colours[curve % std::size(colours)], markers[curve % std::size(markers)]};
}

}  // namespace

std::vector<ChartSpec> probe_chart_specs(const std::vector<std::string>& probes) {
  std::vector<ChartSpec> specs;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const auto words = cloth::words_of_probe_column(probes[k]);
    if (!words) continue;
    const ProbeAxis axis = probe_axis(probes[k], words->unit);
    auto spec =
        std::find_if(specs.begin(), specs.end(), [&](const ChartSpec& s) { return s.key == axis.key; });
    if (spec == specs.end()) spec = specs.insert(spec, ChartSpec{axis.key, axis.title, axis.unit, false, {}});
    spec->curves.push_back({QString::fromStdString(words->label), Source::samples, sample_columns + k,
                            axis.scale, probe_style(spec->curves.size())});
  }
  return specs;
}

const CurveSpec& limit_spec() {
  static const CurveSpec spec{
      "Deformation rate", Source::samples, strain, 100, {&Theme::limit, Marker::none, 1.5, Qt::DashLine}};
  return spec;
}

}  // namespace clothlab
