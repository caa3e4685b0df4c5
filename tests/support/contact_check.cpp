#include "support/contact_check.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <stdexcept>
#include <vector>

#include "measure/energy.h"
#include "simulation/time_step.h"
#include "support/states.h"

namespace cloth::test {
namespace {

constexpr double sixtieth = 1.0 / 60;  // s

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void check_frame(const Simulation& simulation, CheckedRun& run) {
  ++run.frames;
  const Count count = all_crossings(simulation);
  if (count.number == 0) return;
  if (run.crossings.number == 0) run.crossings.first = count.first, run.crossed_at = simulation.time();
  run.crossings.number += count.number;
}

Scene with_verlet(Scene scene) {
  scene.integrator.method = "verlet";
  scene.integrator.time_step.reset();
  scene.integrator.time_step = resolved_time_step(scene).value();
  return scene;
}

void step_on(Simulation& simulation) {
  if (const auto stop = simulation.step()) throw std::runtime_error(describe(*stop));
}

}  // namespace

double frame_interval(const Scene& scene) {
  return scene.record.interval > 0 ? std::min(scene.record.interval, sixtieth) : sixtieth;
}

CheckedRun check_run(const Scene& scene, const CheckedWay& way) {
  Simulation simulation(scene, way.prepare);
  if (way.start) simulation.restore(*way.start);
  CheckedRun run;
  run.begin = run.end = simulation.time();
  const double step = simulation.time_step();
  const std::int64_t steps = steps_to_cover(way.duration, step);
  const double interval = way.interval > 0 ? way.interval : frame_interval(scene);
  constexpr double rounding = 1e-6;
  const auto stride = std::max<std::int64_t>(1, static_cast<std::int64_t>(interval / step + rounding));
  for (std::int64_t n = 1; n <= steps; ++n) {
    const double begin = processor_seconds();
    run.stop = simulation.step();
    run.cost += processor_seconds() - begin;
    run.touched = std::max(run.touched, simulation.last_contact().contacts);
    run.held_back = std::max(run.held_back, simulation.last_contact().held_back);
    run.end = simulation.time();
    run.gave_up = run.cost > way.patience && n < steps;
    // The state that a run was stopped at was led through contact like any other, but for a pinch: there the
    // obstacle stands where it could not get to.
    const bool can_be_checked =
        !run.stop || (all_finite(simulation.state().position) && !simulation.last_contact().pinch);
    const bool is_last = n == steps || run.gave_up || run.stop;
    if (can_be_checked && (n % stride == 0 || is_last)) check_frame(simulation, run);
    if (is_last) break;
  }
  return run;
}

RestingRun rest_run(const Scene& scene, const RestingWay& way) {
  constexpr double resting_part = 1e-6;
  Simulation simulation(scene, way.prepare);
  RestingRun run;
  run.resting_since = infinity;
  std::optional<Vec3Field> there;
  while (simulation.time() + 0.5 * simulation.time_step() < way.time + way.watched) {
    if ((run.stop = simulation.step())) return run;
    const double kinetic = kinetic_energy(simulation.system(), simulation.state().velocity);
    run.peak = std::max(run.peak, kinetic);
    const bool rests = kinetic < resting_part * run.peak;
    run.resting_since = rests ? std::min(run.resting_since, simulation.time()) : infinity;
    if (simulation.time() + 0.5 * simulation.time_step() < way.time) continue;
    const Vec3Field& position = simulation.state().position;
    if (!there) there = position, run.kinetic = kinetic;
    run.highest_after = std::max(run.highest_after, kinetic);
    for (std::size_t i = 0; i < position.size(); ++i)
      run.furthest_after = std::max(run.furthest_after, (position[i] - (*there)[i]).norm());
  }
  run.touched = simulation.last_contact().contacts;
  return run;
}

ContactLedger ledger_run(const Scene& scene, const Preparation& prepare, double duration) {
  Simulation simulation(scene, prepare);
  ContactLedger ledger;
  ledger.account.add(simulation.measure());
  std::vector<double> costs;
  const std::int64_t steps = steps_to_cover(duration, simulation.time_step());
  for (std::int64_t n = 0; n < steps && !ledger.stop; ++n) {
    const double begin = thread_seconds();
    ledger.stop = simulation.step();
    costs.push_back(thread_seconds() - begin);
    if (costs.back() > ledger.worst_step)
      ledger.worst_step = costs.back(), ledger.worst_at = simulation.time();
    const Measurement now = simulation.measure();
    const double given = now.ledger.contact - ledger.work;
    ledger.work = now.ledger.contact;
    ledger.positive += std::max(given, 0.0);
    ledger.largest_gift = std::max(ledger.largest_gift, given);
    ledger.largest_strain = std::max(ledger.largest_strain, now.strain.maximum());
    ledger.gain = std::max(ledger.gain, now.energy_error());
    ledger.account.add(now);
  }
  const auto middle = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2);
  std::nth_element(costs.begin(), middle, costs.end());
  ledger.median_step = *middle;
  return ledger;
}

Checkpoint state_at(const Scene& scene, double time) {
  Simulation simulation(with_verlet(scene));
  while (simulation.time() + 0.5 * simulation.time_step() < time) step_on(simulation);
  return simulation.checkpoint();
}

Checkpoint state_before_touch(const Scene& scene, double lead) {
  Simulation simulation(with_verlet(scene));
  std::deque<Checkpoint> last{simulation.checkpoint()};
  while (simulation.last_contact().contacts == 0 && simulation.time() < scene.duration) {
    if (simulation.time() - last.back().state.time >= lead) last.push_back(simulation.checkpoint());
    if (last.size() > 2) last.pop_front();
    step_on(simulation);
  }
  return last.front();
}

Scene coarser(Scene scene, double part) {
  const auto fewer = [part](int count) {
    return std::max(3, static_cast<int>(std::lround((count - 1) * part)) + 1);
  };
  scene.cloth.rows = fewer(scene.cloth.rows);
  scene.cloth.columns = fewer(scene.cloth.columns);
  return scene;
}

Vec3Field force_after_step(ForceModel& forces, const ClothState& ended, double weight,
                           const Vec3Field& position) {
  Vec3Field velocity = ended.velocity, force(position.size());
  for (std::size_t i = 0; i < position.size(); ++i)
    velocity.add(i, (position[i] - ended.position[i]) / weight);
  forces.update(position, weight);
  forces.force(position, velocity, force);
  return force;
}

}  // namespace cloth::test
