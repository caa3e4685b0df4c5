#include "study/iterations.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "integrators/implicit/implicit_stage.h"
#include "integrators/registry.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "simulation/simulation.h"
#include "study/iterations_report.h"
#include "study/step_objective.h"

namespace cloth {
namespace {

constexpr double solution_tolerance = 1e-12;
constexpr int solution_most = 500;

/// The step that is studied, and its solution.
struct StudiedStep {
  Scene scene;
  ClothSystem system;
  ClothState start;
  double step = 0;
  StepTimes times() const { return {start.time, start.time + step, step}; }
};

struct Solution {
  Vec3Field velocity;
  std::string failure{};
};

Solution solution_from(const StudiedStep& studied, const Vec3Field& guess) {
  ForceModel forces(studied.scene, studied.system);
  Solution found{guess};
  Vec3Field position(guess.size());
  IntegratorReport report;
  ImplicitStage stage(solution_tolerance, solution_most);
  stage.solve({forces, studied.step, studied.times().end, studied.start.position, studied.start.velocity,
               found.velocity, position, report});
  if (report.failure) found.failure = report.failure->cause;
  return found;
}

StepObjective objective_of(const StudiedStep& studied) {
  ForceModel forces(studied.scene, studied.system);
  forces.update_external(studied.start.position, studied.times().end);
  const NodeDamping parts = forces.damping_parts();
  std::vector<double> inertia = studied.system.mass;
  Vec3Field predicted = studied.start.velocity;
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    const double mass = inertia[i];
    inertia[i] += studied.step * parts.isotropic.of(mass);
    if (!studied.system.pinned[i])
      predicted.set(i, (mass * predicted[i] + studied.step * forces.position_force()[i]) / inertia[i]);
  }
  return {studied.system, studied.step, std::move(inertia), studied.start.position, std::move(predicted)};
}

/// Moves every component by as much as rounding of its position does, to either side.
Vec3Field rounded_otherwise(const StudiedStep& studied, const Vec3Field& velocity) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  Vec3Field moved = velocity;
  const auto v = moved.flat();
  const auto x = studied.start.position.flat();
  for (std::size_t k = 0; k < v.size(); ++k)
    if (!studied.system.pinned[k % studied.system.pinned.size()])
      v[k] += (k % 2 == 0 ? eps : -eps) * (std::abs(x[k]) / studied.step + std::abs(v[k]));
  return moved;
}

/// What the solution leaves of the step equations, and whether G has a minimum there.
void check_solution(const StudiedStep& studied, const Vec3Field& velocity, IterationsStudy& study) {
  ForceModel forces(studied.scene, studied.system);
  Vec3Field end = studied.start.position, force(velocity.size());
  add_scaled(studied.step, velocity, end);
  forces.update(end, studied.times().end);
  forces.force(end, velocity, force);
  for (std::size_t i = 0; i < velocity.size(); ++i)
    if (!studied.system.pinned[i])
      study.residual = std::max(
          study.residual,
          (studied.system.mass[i] * (velocity[i] - studied.start.velocity[i]) - studied.step * force[i])
              .norm());
  Linearisation linearisation;
  forces.linearise(end, {.position = studied.step * studied.step, .velocity = studied.step, .clamped = false},
                   linearisation);
  CholeskyFactors factors;
  study.is_minimum = factors.factorise(studied.system, linearisation);
}

IntegratorChoice choice_of(const std::string& method, int iterations) {
  IntegratorChoice choice{method};
  choice.tolerance = std::numeric_limits<double>::epsilon();
  choice.newton_iterations = choice.projective_iterations = choice.xpbd_iterations = choice.vbd_iterations =
      iterations;
  choice.substeps = 1;
  return choice;
}

/// 1, 2, 3, 4, 6, 8, 12, 16, ...
int next_rung(int iterations) {
  if (iterations < 4) return iterations + 1;
  const bool is_power = (iterations & (iterations - 1)) == 0;
  return is_power ? iterations / 2 * 3 : iterations / 3 * 4;
}

struct Solved {
  IteratedStep step;
  IntegratorReport report;
};

Solved solve_with(const StudiedStep& studied, const std::string& method, int iterations, int repeats,
                  const StepObjective& objective, const Vec3Field& solution, double fall) {
  ForceModel forces(studied.scene, studied.system);
  const auto integrator = make_integrator(choice_of(method, iterations));
  Solved solved{.step = {.iterations = iterations, .seconds = std::numeric_limits<double>::infinity()},
                .report = {}};
  ClothState state;
  Work work;
  for (int repeat = 0; repeat <= repeats; ++repeat) {  // the first is the warm-up
    state = studied.start;
    const auto begin = std::chrono::steady_clock::now();
    solved.report = integrator->step(forces, studied.times(), state, work);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (repeat > 0 || seconds > 0.5) solved.step.seconds = std::min(solved.step.seconds, seconds);
    if (seconds > 0.5) break;
  }
  solved.step.objective = objective.difference(state.velocity, solution) / fall;
  return solved;
}

}  // namespace

const std::vector<std::string>& iterated_methods() {
  static const std::vector<std::string> methods{"implicit-euler", "projective", "xpbd", "vbd"};
  return methods;
}

Scene scene_of_iterations(const Scene& scene, std::vector<std::string>& left_out) {
  Scene studied = scene;
  const auto leave_out = [&](bool is_there, const char* what) {
    if (is_there) left_out.emplace_back(what);
    return is_there;
  };
  if (leave_out(scene.springs && scene.springs->damping > 0, "damping along springs"))
    studied.springs->damping = 0;
  if (leave_out(scene.air.has_value(), "air")) studied.air.reset();
  if (leave_out(scene.deformation.has_value(), "the deformation rate")) studied.deformation.reset();
  if (leave_out(!scene.obstacles.empty(), "obstacles")) studied.obstacles.clear();
  if (leave_out(scene.self_contact.has_value(), "contact of the cloth with itself"))
    studied.self_contact.reset();
  studied.contact.reset(), studied.probes.clear(), studied.measured.reset();
  if (Material* m = studied.material ? &*studied.material : nullptr) {
    if (leave_out(m->stretch_damping > 0 || m->bending_damping > 0, "dampers of the material"))
      m->stretch_damping = m->bending_damping = 0;
    if (leave_out(m->hysteresis_warp > 0 || m->hysteresis_weft > 0, "hysteresis"))
      m->hysteresis_warp = m->hysteresis_weft = 0;
    leave_out((m->drag_normal > 0 || m->drag_tangential > 0) && !scene.air, "air");
    m->drag_normal = m->drag_tangential = 0;
  }
  return studied;
}

std::vector<Problem> find_problems(const Scene& scene, const IterationsOptions& options) {
  std::vector<Problem> problems;
  if (!has_stiffness(scene))
    problems.push_back(
        {"--scene", "without springs", "must have springs or a material that an iteration could solve for"});
  if (options.step && !(*options.step > 0 && std::isfinite(*options.step)))
    problems.push_back({"--step", fmt::format("{}", *options.step), "must be above 0 s"});
  if (!(options.time >= 0 && std::isfinite(options.time)))
    problems.push_back({"--time", fmt::format("{}", options.time), "must be at least 0 s"});
  return problems;
}

bool is_finished(const MethodIterations& method, int most) {
  if (!method.remark.empty()) return true;
  return !method.steps.empty() && next_rung(method.steps.back().iterations) > most;
}

bool IterationsStudy::is_complete() const {
  if (stopped) return false;
  return !failure.empty() || (methods.size() == asked.size() && is_finished(methods.back(), most));
}

Scene scene_of(const IterationsStudy& study, const MethodIterations& method, const IteratedStep& step) {
  Scene scene = study.scene;
  scene.integrator = choice_of(method.method, step.iterations);
  scene.integrator.time_step = study.step;
  return scene;
}

const IteratedStep* first_below(const MethodIterations& method, double objective) {
  for (const IteratedStep& step : method.steps)
    if (step.objective <= objective) return &step;
  return nullptr;
}

namespace {

/// The scene's motion up to the step that is studied; a failure is said in `study`.
StudiedStep step_in_motion(const IterationsOptions& options, IterationsStudy& study) {
  Simulation simulation(study.scene);
  const auto steps = static_cast<int>(std::lround(options.time / study.step));
  for (int n = 0; n < steps && study.failure.empty(); ++n) {
    if (is_to_stop(options.stop)) study.stopped = true;
    if (study.stopped) break;
    if (const auto divergence = simulation.step()) study.failure = describe(*divergence);
  }
  study.time = simulation.time(), study.particles = simulation.system().size();
  return {study.scene, make_cloth(study.scene), simulation.state(), study.step};
}

/// Adds the method to the study, rung by rung.
void iterate(const StudiedStep& studied, const std::string& method, const IterationsOptions& options,
             const StepObjective& objective, const Vec3Field& solution, IterationsStudy& study) {
  const auto before = static_cast<double>(study.methods.size());
  MethodIterations& found = study.methods.emplace_back(MethodIterations{.method = method});
  double spent = 0;
  for (int iterations = 1; iterations <= options.most; iterations = next_rung(iterations)) {
    const double done = before + std::log(iterations) / std::log(options.most + 1.0);
    if (is_to_stop(options.stop) ||
        (options.progress &&
         !options.progress({done / static_cast<double>(study.asked.size()),
                            fmt::format("{}, {} iterations", title_of_iterated(method), iterations)}))) {
      study.stopped = true;
      break;
    }
    const auto [step, report] =
        solve_with(studied, method, iterations, options.repeats, objective, solution, study.fall);
    found.steps.push_back(step);
    spent += (options.repeats + 1) * step.seconds;
    const bool is_newton = method == "implicit-euler";
    if (!std::isfinite(step.objective) || (report.failure && !is_newton)) {
      found.steps.back().objective = std::numeric_limits<double>::quiet_NaN();
      found.remark = report.failure ? report.failure->cause : "its velocities are not finite";
    } else if (step.objective <= study.floor) {
      found.remark = "at the floor";
    } else if (is_newton && report.iterations < iterations) {
      found.remark = "Newton's method ended by itself";
    } else if (spent > options.budget) {
      found.remark = fmt::format("more would take longer than {:.3g} s", options.budget);
    }
    if (options.partial) options.partial(study);
    if (!found.remark.empty()) break;
  }
  if (found.steps.empty()) study.methods.pop_back();
}

/// Null where it is not known.
const MethodIterations* finished_before(const IterationsStudy* earlier, const std::string& method, int most) {
  if (!earlier) return nullptr;
  for (const MethodIterations& known : earlier->methods)
    if (known.method == method && is_finished(known, most)) return &known;
  return nullptr;
}

}  // namespace

IterationsStudy plan_iterations_study(const Scene& scene, const IterationsOptions& options) {
  constexpr double step_of_auto = 0.01;
  IterationsStudy study;
  study.scene = scene_of_iterations(scene, study.left_out);
  study.step = options.step.value_or(scene.integrator.time_step.value_or(step_of_auto));
  study.scene.integrator = {"implicit-euler", study.step};
  study.asked = options.methods.empty() ? iterated_methods() : options.methods;
  study.asked_time = options.time;
  study.most = options.most;
  return study;
}

IterationsStudy run_iterations_study(const Scene& scene, const IterationsOptions& options) {
  IterationsStudy study = plan_iterations_study(scene, options);
  const StudiedStep studied = step_in_motion(options, study);
  if (!study.failure.empty() || study.stopped) return study;

  const Solution found = solution_from(studied, studied.start.velocity);
  const Solution again = solution_from(studied, Vec3Field(studied.start.velocity.size()));
  study.failure = !found.failure.empty() ? found.failure : again.failure;
  if (!study.failure.empty()) return study;
  const StepObjective objective = objective_of(studied);
  study.fall = objective.difference(objective.predicted(), found.velocity);
  check_solution(studied, found.velocity, study);
  const Vec3Field moved = rounded_otherwise(studied, found.velocity);
  const double by_rounding = std::abs(objective.difference(moved, found.velocity));
  if (!(study.fall > by_rounding)) {
    study.failure = "nothing is to be solved: the step ends where inertia takes the cloth";
    return study;
  }
  study.floor =
      std::max(std::abs(objective.difference(again.velocity, found.velocity)), by_rounding) / study.fall;
  for (const std::string& method : study.asked) {
    if (study.stopped) break;
    if (const MethodIterations* known = finished_before(options.earlier, method, study.most))
      study.methods.push_back(*known);
    else
      iterate(studied, method, options, objective, found.velocity, study);
  }
  return study;
}

}  // namespace cloth
