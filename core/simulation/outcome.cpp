#include "simulation/outcome.h"

#include <fmt/format.h>

#include <cmath>

namespace cloth {

const char* name_of(Status status) {
  constexpr const char* names[] = {"finished", "stopped", "diverged"};
  return names[static_cast<std::size_t>(status)];
}

StepCount StepCount::since(const StepCount& earlier) const {
  return {.steps = steps - earlier.steps,
          .force_evaluations = force_evaluations - earlier.force_evaluations,
          .velocity_iterations = velocity_iterations - earlier.velocity_iterations,
          .limiter_sweeps = limiter_sweeps - earlier.limiter_sweeps,
          .inner_steps = inner_steps - earlier.inner_steps,
          .rejected_steps = rejected_steps - earlier.rejected_steps,
          .iterations = iterations - earlier.iterations,
          .linear_iterations = linear_iterations - earlier.linear_iterations,
          .factorisations = factorisations - earlier.factorisations,
          .held_normals = held_normals - earlier.held_normals,
          .largest_residual = largest_residual};
}

std::string describe(const StepCount& count) {
  if (count.held_normals == 0) return "";
  const bool once = count.held_normals == 1;
  return fmt::format(
      "in {} step{}, which nothing else solved, air acted along the cloth's normals at {} beginning; shorter "
      "steps are easier to solve",
      count.held_normals, once ? "" : "s", once ? "its" : "their");
}

std::string describe(const Divergence& d) {
  const std::string where = d.on_grid ? fmt::format(" (row {}, column {})", d.row, d.column) : "";
  if (d.pinched)
    return fmt::format("pinched in step {} (t = {:.6g} s) at particle {}{}: {}", d.step, d.time, d.particle,
                       where, d.cause);
  std::string advice;
  if (d.solver_failed)
    advice = fmt::format("the time step is {:.4g} s; a shorter one makes the equations easier", d.time_step);
  else if (std::isinf(d.stable_step))
    advice = fmt::format("the time step is {:.4g} s, any is stable for a linear scene, but not for this one",
                         d.time_step);
  else if (d.stable_step <= 0)
    advice = "this method has no stable time step for this scene";
  else
    advice = fmt::format("the time step is {:.4g} s, stable in every shape of this cloth is up to {:.4g} s",
                         d.time_step, d.stable_step);
  return fmt::format("{} in step {} (t = {:.6g} s) at particle {}{}: {}; {}",
                     d.solver_failed ? "stopped" : "diverged", d.step, d.time, d.particle, where, d.cause,
                     advice);
}

std::string describe(const std::vector<StepChange>& changes) {
  if (changes.empty()) return "";
  std::string text = "the ledger found energy that nothing explains, and auto shortened the step to ";
  for (const StepChange& change : changes)
    text += fmt::format("{}{:.6g} s at t = {:.6g} s", &change == changes.data() ? "" : ", ", change.time_step,
                        change.time);
  return text;
}

std::string describe(const RateBreach& b) {
  const auto particle = [&](int i) {
    return b.columns > 0 ? fmt::format("{} (row {}, column {})", i, i / b.columns, i % b.columns)
                         : std::to_string(i);
  };
  const std::string also = b.steps > 1
                               ? fmt::format("; so it was in {} steps, worst in step {} with {:.3g} %",
                                             b.steps, b.largest_step, 100 * b.largest_excess)
                               : "";
  const char* why = b.unreachable  ? ", which the pins make unreachable"
                    : b.by_contact ? ", where contact has stretched it"
                                   : "";
  return fmt::format(
      "rate not kept: in step {} (t = {:.6g} s) the spring between particles {} and {} is left {:.3g} % of "
      "its rest length beyond deformation.rate{}{}",
      b.first_step, b.first_time, particle(b.first_particle), particle(b.second_particle),
      100 * b.first_excess, why, also);
}

}  // namespace cloth
