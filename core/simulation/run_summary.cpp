#include "simulation/run_summary.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/machine.h"
#include "io/process.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// JSON has no NaN: a number that is not finite is written as a word.
json finite_or_word(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "infinity" : "-infinity";
}

json divergence_json(const Divergence& d) {
  return {{"step", d.step},
          {"time_s", d.time},
          {"particle", d.particle},
          {"row", d.on_grid ? json(d.row) : json()},
          {"column", d.on_grid ? json(d.column) : json()},
          {"cause", d.cause},
          {"time_step_s", d.time_step},
          {"stable_step_s", d.stable_step > 0 ? finite_or_word(d.stable_step) : json()},
          {"message", describe(d)}};
}

/// What a method's own equations took beside force evaluations; only what there was.
json solver_json(const StepCount& count) {
  json solver;
  const auto note = [&](const char* name, std::int64_t number) {
    if (number > 0) solver[name] = number;
  };
  if (count.inner_steps != count.steps) note("inner_steps", count.inner_steps);
  note("rejected_steps", count.rejected_steps);
  note("iterations", count.iterations);
  note("linear_iterations", count.linear_iterations);
  note("factorisations", count.factorisations);
  note("steps_with_held_normals", count.held_normals);
  note("velocity_iterations", count.velocity_iterations);
  note("limiter_sweeps", count.limiter_sweeps);
  if (count.iterations > 0) solver["largest_residual"] = finite_or_word(count.largest_residual);
  return solver;
}

}  // namespace

std::string state_csv(const ClothState& state) {
  std::string text = "particle,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n";
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3 x = state.position[i], v = state.velocity[i];
    text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", i, x.x(), x.y(), x.z(), v.x(),
                        v.y(), v.z());
  }
  return text;
}

double RunSummary::nanoseconds_per_particle_step() const {
  return count.steps > 0 && particles > 0 ? wall * 1e9 / (static_cast<double>(count.steps) * particles) : 0;
}

nlohmann::ordered_json breach_json(const RateBreach& breach) {
  return {{"message", describe(breach)},
          {"first_step", breach.first_step},
          {"first_time_s", breach.first_time},
          {"particles", {breach.first_particle, breach.second_particle}},
          {"by_contact", breach.by_contact},
          {"first_excess", breach.first_excess},
          {"largest_excess", breach.largest_excess},
          {"largest_step", breach.largest_step},
          {"steps", breach.steps}};
}

std::string summary_json(const RunSummary& s) {
  json root{{"program", "clothlab"},
            {"version", version()},
            {"kind", "run"},
            {"scene_hash", s.scene_hash},
            {"title", s.title},
            {"method", s.method},
            {"time_step_s", s.time_step},
            {"steps", s.count.steps},
            {"force_evaluations", s.count.force_evaluations},
            {"particles", s.particles},
            {"simulated_s", s.simulated},
            {"wall_s", s.wall},
            {"ns_per_particle_step", s.nanoseconds_per_particle_step()},
            {"max_strain", finite_or_word(s.max_strain)},
            {"energy_drift_J", finite_or_word(s.energy.error())},
            {"largest_energy_error_J", finite_or_word(s.energy.largest_error())},
            {"energy_exchanged_J", finite_or_word(s.energy.exchanged())},
            {"energy_error_share", finite_or_word(s.energy.share())},
            {"limiter_excess", finite_or_word(s.limiter_excess)},
            {"status", name_of(s.status)}};
  if (json solver = solver_json(s.count); !solver.empty()) root["solver"] = std::move(solver);
  if (s.divergence) root["diverged"] = divergence_json(*s.divergence);
  for (const StepChange& change : s.step_changes)
    root["time_step_changes"].push_back(
        {{"step", change.step}, {"time_s", change.time}, {"time_step_s", change.time_step}});
  if (s.rate_breach) root["rate_not_kept"] = breach_json(*s.rate_breach);
  if (!s.notice.empty()) root["notice"] = s.notice;
  if (!s.files.empty()) root["files"] = digests_json(s.files);
  root["threads"] = s.threads;
  root["host"] = {{"name", host_name()},
                  {"processor", processor_name()},
                  {"instruction_set", name_of(active_instruction_set())},
                  {"compiler", compiler_name()},
                  {"build", build_type()}};
  return root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace cloth
