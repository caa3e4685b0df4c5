#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/speed/speed_tables.h"

namespace cloth::speed {
namespace {

using json = nlohmann::ordered_json;

json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json positive(double value) {
  return value > 0 ? finite(value) : json();
}

json spread_json(const Spread& s) {
  if (!(s.median > 0)) return {};
  return {{"median", finite(s.median)},
          {"low", finite(s.low)},
          {"high", finite(s.high)},
          {"least", finite(s.least)}};
}

json text_or_null(const std::string& text) {
  return text.empty() ? json() : json(text);
}

json machine_json(const MachineFacts& facts) {
  return {{"processor", facts.processor},
          {"cores", facts.cores},
          {"operating_system", facts.operating_system},
          {"compiler", facts.compiler},
          {"flags", facts.flags},
          {"build", facts.build_type},
          {"date", facts.date}};
}

json yardsticks_json(const Yardsticks& y) {
  if (!(y.update.median > 0)) return {};
  return {{"scalar_root_and_division_ns", spread_json(y.scalar_root)},
          {"vector_root_and_division_ns", spread_json(y.vector_root)},
          {"vectors", y.vectors},
          {"triad_GB_per_s", finite(y.triad_throughput())},
          {"update_GB_per_s", finite(y.update_throughput())},
          {"triad_ns_per_element", spread_json(y.triad)},
          {"update_ns_per_element", spread_json(y.update)},
          {"array_bytes", y.array_bytes},
          {"cores", y.cores},
          {"cores_gain_together", spread_json(y.together)}};
}

json row_json(const StepCost& row) {
  json object{{"size", row.size},
              {"method", row.method},
              {"feature", row.feature},
              {"threads", row.threads},
              {"time_step_s", positive(row.time_step)},
              {"samples", row.samples},
              {"ns_per_particle_step", spread_json(row.time)},
              {"ratio_to_reference", spread_json(row.to_reference)},
              {"ratio_to_bare", spread_json(row.to_bare)},
              {"ratio_to_divider_floor", positive(row.to_divider)},
              {"ratio_to_memory_floor", positive(row.to_memory)},
              {"force_evaluations_per_step", positive(row.evaluations)}};
  if (row.inner_steps > 1) object["inner_steps_per_step"] = row.inner_steps;
  if (row.sweeps > 0) object["limiter_sweeps_per_step"] = row.sweeps;
  if (row.velocity_iterations > 0) object["velocity_iterations_per_step"] = row.velocity_iterations;
  if (row.linear_iterations > 0) object["linear_iterations_per_step"] = row.linear_iterations;
  if (!row.remark.empty()) object["remark"] = row.remark;
  return object;
}

json growth_json(const Growth& row) {
  return {{"method", row.method},
          {"feature", row.feature},
          {"threads", row.threads},
          {"sizes", row.exponent.points},
          {"smallest_size", row.smallest},
          {"largest_size", row.largest},
          {"exponent", finite(row.exponent.value)},
          {"standard_error", row.exponent.points > 2 ? finite(row.exponent.standard_error) : json()}};
}

json contact_json(const ContactCost& cost) {
  return {{"scene", cost.scene},
          {"rows", cost.rows},
          {"columns", cost.columns},
          {"obstacle_triangles", cost.obstacle_triangles},
          {"self_contact", cost.with_itself},
          {"touched_particles", cost.touched},
          {"pairs", cost.pairs},
          {"ns_per_particle_step_without", spread_json(cost.without)},
          {"ns_per_particle_step", spread_json(cost.with)},
          {"ratio_to_without", spread_json(cost.ratio)},
          {"remark", text_or_null(cost.remark)}};
}

json scene_json(const SceneSpeed& scene) {
  return {{"name", scene.name},
          {"method", scene.method},
          {"size", scene.size > 0 ? json(scene.size) : json()},
          {"rows", scene.rows > 0 ? json(scene.rows) : json()},
          {"columns", scene.columns > 0 ? json(scene.columns) : json()},
          {"particles", scene.particles},
          {"time_step_s", positive(scene.time_step)},
          {"duration_s", finite(scene.duration)},
          {"simulated_s", finite(scene.simulated)},
          {"stepping_s", finite(scene.seconds)},
          {"simulated_per_stepping", finite(scene.speed())},
          {"ns_per_particle_step", positive(scene.nanoseconds)},
          {"bare_ns_per_particle_step", positive(scene.bare)},
          {"ratio_to_bare", positive(scene.to_bare())},
          {"remark", text_or_null(scene.remark)}};
}

json scene_growth_json(const SceneGrowth& row) {
  return {{"scene", row.name},
          {"sizes", row.exponent.points},
          {"fewest_particles", row.smallest},
          {"most_particles", row.largest},
          {"exponent", finite(row.exponent.value)},
          {"standard_error", row.exponent.points > 2 ? finite(row.exponent.standard_error) : json()}};
}

json memory_json(const MemoryCost& row) {
  return {{"method", row.method},
          {"feature", row.feature},
          {"size", row.size},
          {"held_bytes_per_particle", row.held ? finite(*row.held) : json()},
          {"peak_bytes_per_particle", row.peak ? finite(*row.peak) : json()}};
}

json start_json(const StartCost& row) {
  return {{"what", row.what},
          {"ms", spread_json(row.milliseconds)},
          {"samples", row.samples},
          {"remark", text_or_null(row.remark)}};
}

template <class Rows, class ToJson>
json list_of(const Rows& rows, ToJson to_json) {
  json list = json::array();
  for (const auto& row : rows) list.push_back(to_json(row));
  return list;
}

}  // namespace

std::string speed_json(const SpeedReport& report) {
  const json root{{"program", "clothlab"},
                  {"kind", "bench"},
                  {"version", report.machine.version},
                  {"complete", report.complete},
                  {"machine", machine_json(report.machine)},
                  {"repeats", report.repeats},
                  {"hanging_time_s", hanging_time},
                  {"yardsticks", yardsticks_json(report.yardsticks)},
                  {"reference_disagreement_m", report.rows.empty() ? json() : finite(report.disagreement)},
                  {"rows", list_of(report.rows, row_json)},
                  {"growth", list_of(report.growth, growth_json)},
                  {"contact", list_of(report.contact, contact_json)},
                  {"scenes", list_of(report.scenes, scene_json)},
                  {"scene_growth", list_of(report.scene_growth, scene_growth_json)},
                  {"memory", list_of(report.memory, memory_json)},
                  {"start", list_of(report.starts, start_json)}};
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace cloth::speed
