#include "charts/chart_record.h"

#include <array>
#include <cmath>

namespace clothlab {

void ChartRecord::append(std::span<const ChartSample> batch) {
  for (const ChartSample& s : batch) {
    if (s.is_cut) {
      samples.drop_after(s.time_s);
      draws.drop_after(s.time_s);
      continue;
    }
    if (!samples.empty() && s.time_s < samples.last_time()) clear();
    const std::array<double, sample_columns> row{s.kinetic_J, s.elastic_J,  s.gravity_J,
                                                 s.total_J,   s.max_strain, s.step_ms};
    samples.append(s.time_s, row);
    if (std::isfinite(s.draw_ms)) append_draw_time(s.time_s, s.draw_ms);
  }
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

const CurveSpec& limit_spec() {
  static const CurveSpec spec{
      "Deformation rate", Source::samples, strain, 100, {&Theme::limit, Marker::none, 1.5, Qt::DashLine}};
  return spec;
}

}  // namespace clothlab
