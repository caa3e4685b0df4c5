// Verlet with its damping at a velocity that is not solved for (integrators/verlet.h), predicted by a step or
// corrected: the recurrences, the limits from both sides, the order, the fused pass against the general
// method, and when which is chosen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cloth/grid.h"
#include "integrators/fused_steppers.h"
#include "integrators/registry.h"
#include "limiter/spring_tensions.h"
#include "measure/energy.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_cloth.h"
#include "simulation/simulation.h"
#include "simulation/stages.h"
#include "simulation/time_step.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::predicted_damping_test {
namespace {

constexpr double stiffness = 40, mass = 0.1, spacing = 0.5;
const double omega = std::sqrt(stiffness / mass);

/// Two particles below two pins that move up and down together: one oscillator, x'' = -omega^2 x - c x', with
/// c = rate from dampers along its springs.
class DampedOscillator {
 public:
  DampedOscillator(EndVelocity end, double rate, double start) : run_(scene(rate), "verlet"), start_(start) {
    run_.take_damping(end);
    for (const std::size_t i : {2u, 3u}) run_.state.position.add(i, {0, start, 0});
  }
  double x() const { return (run_.state.position[2].y() + spacing) / start_; }
  void step(double h) { run_.advance(1, h); }
  /// As continuous contact makes a step that it leaves as it is.
  void step_beside_contact(Integrator& method, double h) {
    const StepTimes times{0, h, h};
    const Vec3Field before = run_.state.position;
    method.open_step(run_.forces, times, run_.state, run_.work);
    Vec3Field half = run_.state.position;
    for (std::size_t i = 0; i < half.size(); ++i) half.set(i, (half[i] - before[i]) / h);
    method.update_velocity_for_positions(run_.forces, times, half, run_.state);
    method.update_velocity_for_damping(run_.forces, times, half, run_.state);
    run_.work += method.correct_work(run_.forces, times, run_.state);
  }
  StepperKind kind(EndVelocity end) { return stepper_kind("verlet", run_.forces, {.end_velocity = end}); }

 private:
  static Scene scene(double rate) {
    Scene scene = bare_sheet(2, 2, spacing, mass);
    scene.cloth.pins = {NamedPin::top_edge};
    scene.springs = only(SpringFamily::structural, stiffness);
    scene.springs->damping = rate * mass;
    return scene;
  }
  DirectRun run_;
  double start_;
};

TEST(PredictedDamping, MovesAnOscillatorByItsRecurrence) {
  for (const double w : {0.1, 0.7, 1.5})
    for (const double g : {0.01, 0.1, 0.4}) {
      DampedOscillator oscillator(EndVelocity::predicted, g * omega / w, 0.01);
      ASSERT_EQ(oscillator.kind(EndVelocity::predicted),
                (StepperKind{.fused = true, .end_velocity = EndVelocity::predicted}));
      std::vector<double> x;
      for (int n = 0; n < 40; ++n) {
        x.push_back(oscillator.x());
        oscillator.step(w / omega);
      }
      EXPECT_LT(std::abs(x[39]), 1.1);
      for (std::size_t n = 1; n + 3 < x.size(); ++n)
        EXPECT_NEAR(x[n + 3] + (w * w + 1.5 * g - 2) * x[n + 2] + (1 - 2 * g) * x[n + 1] + 0.5 * g * x[n], 0,
                    1e-12)
            << w << " " << g << " " << n;
    }
}

/// A thousand steps from a start of a micrometre.
double growth(EndVelocity end, double w, double g) {
  DampedOscillator oscillator(end, g * omega / w, 1e-6);
  double largest = 0;
  for (int n = 0; n < 1000; ++n) {
    oscillator.step(w / omega);
    if (n >= 900) largest = std::max(largest, std::abs(oscillator.x()));
  }
  return largest;
}

TEST(PredictedDamping, IsStableBelowItsLimitAndGrowsAboveIt) {
  for (const double share : {0.1, 0.3, 0.6, 0.9}) {  // of the limit that the damping takes
    const auto at = [&](double load) {
      return growth(EndVelocity::predicted, std::sqrt(4 * load * (1 - share)), load * share);
    };
    EXPECT_LT(at(0.98), 1e-3) << share;
    EXPECT_GT(at(1.02), 10) << share;
  }
}

/// A wind brush is known to no pass. This one blows nowhere.
BrushGust brush_that_touches_nothing() {
  return {.velocity = Vec3::Zero(), .cursor = {1e6, 1e6}, .radius = 1};
}

void expect_order_two(const Scene& scene, EndVelocity end, bool fused) {
  constexpr double time = 0.4;  // s
  const auto solve = [&](const char* method, int steps) {
    DirectRun run(scene, exactly(method));
    run.take_damping(end);
    if (!fused) run.forces.set_brush(brush_that_touches_nothing());
    const StepperKind kind = stepper_kind(method, run.forces, {.end_velocity = end});
    if (std::string(method) == "verlet") {
      EXPECT_EQ(kind, (StepperKind{.fused = fused, .end_velocity = end}));
    }
    run.advance(steps, time / steps);
    return run.state;
  };
  const ClothState exact = solve("rk4", 12800);
  std::vector<double> position, velocity;
  for (const int steps : {400, 800, 1600, 3200}) {
    const ClothState state = solve("verlet", steps);
    position.push_back(rms_distance(state.position, exact.position));
    velocity.push_back(rms_distance(state.velocity, exact.velocity));
  }
  for (const auto* errors : {&position, &velocity})
    for (std::size_t k = 1; k < errors->size(); ++k)
      EXPECT_NEAR(std::log2((*errors)[k - 1] / (*errors)[k]), 2, 0.1);
  EXPECT_GT(position.back(), 1e-12) << "nothing to be measured";
}

TEST(PredictedDamping, IsOfOrderTwoWithDampersDragSkinFrictionWindAndGusts) {
  expect_order_two(damped_smooth_scene(6, 6), EndVelocity::predicted, true);
}

TEST(PredictedDamping, IsOfOrderTwoInTheGeneralMethodToo) {
  expect_order_two(damped_smooth_scene(6, 6), EndVelocity::predicted, false);
}

/// x(n+2) = (1 + d - w^2 s) x(n+1) - d x(n), and a step is stable where w^2 s < 2 (1 + d).
struct Recurrence {
  double determinant, pull;  ///< d, s
};

Recurrence recurrence(EndVelocity end, double g) {
  const double x = g / 2, a = end == EndVelocity::corrected ? 1 - x : 1 - x + x * x / 2;
  return {1 - g * a, a};
}

constexpr EndVelocity evaluated_again[] = {EndVelocity::corrected, EndVelocity::corrected_twice};

TEST(CorrectedDamping, MovesAnOscillatorByItsTraceAndDeterminant) {
  for (const EndVelocity end : evaluated_again)
    for (const double w : {0.1, 0.7, 1.5, 1.9})
      for (const double g : {0.01, 0.3, 1.0, 1.8, 1.95}) {
        DampedOscillator oscillator(end, g * omega / w, 1e-6);
        ASSERT_EQ(oscillator.kind(end), (StepperKind{.fused = true, .end_velocity = end}));
        std::vector<double> x;
        for (int n = 0; n < 20; ++n) {
          x.push_back(oscillator.x());
          oscillator.step(w / omega);
        }
        const auto [d, s] = recurrence(end, g);
        for (std::size_t n = 0; n + 2 < x.size(); ++n)
          EXPECT_NEAR(x[n + 2] - (1 + d - w * w * s) * x[n + 1] + d * x[n], 0, 1e-8)
              << w << " " << g << " " << n;
      }
}

/// Of the velocity at half a step (1 - X) (1 - X A) is left and (1 + (1 - X) A)/2 of the springs' kick acts.
TEST(CorrectedDamping, MovesAnOscillatorBesideContactByItsTraceAndDeterminant) {
  for (const EndVelocity end : evaluated_again)
    for (const bool general : {false, true})
      for (const double w : {0.1, 0.7, 1.9})
        for (const double g : {0.01, 0.3, 1.0, 1.95}) {
          DampedOscillator oscillator(end, g * omega / w, 1e-6);
          Verlet alone(end);
          FusedDampedVerlet fused(end);
          std::vector<double> x;
          for (int n = 0; n < 20; ++n) {
            x.push_back(oscillator.x());
            oscillator.step_beside_contact(general ? alone : fused, w / omega);
          }
          const double half = g / 2, a = recurrence(end, g).pull;
          const double d = (1 - half) * (1 - half * a), pull = w * w * (1 + (1 - half) * a) / 2;
          EXPECT_LT(pull, 2 * (1 + d)) << "it is not stable";
          for (std::size_t n = 0; n + 2 < x.size(); ++n)
            EXPECT_NEAR(x[n + 2] - (1 + d - pull) * x[n + 1] + d * x[n], 0, 1e-8)
                << w << " " << g << " " << n;
        }
}

/// To the limit of an undamped cloth wherever h D is less than 2 m, and beyond by no more than its formula
/// says.
TEST(CorrectedDamping, IsStableToTheLimitOfAnUndampedClothAndGrowsAboveItsOwn) {
  for (const EndVelocity end : evaluated_again)
    for (const double g : {0.05, 0.3, 1.0, 1.5, 1.95}) {
      const auto [d, s] = recurrence(end, g);
      const double limit = std::sqrt(2 * (1 + d) / s);
      EXPECT_GE(limit, 2);
      EXPECT_LT(growth(end, 1.999, g), 2) << g;
      EXPECT_LT(growth(end, 0.999 * limit, g), 2) << g;
      EXPECT_GT(growth(end, 1.02 * limit, g), 10) << g;
    }
}

/// Springs of several stiffnesses and dampers that are equal on all of them have no common eigenvectors.
TEST(CorrectedDamping, MakesNoEnergyInAClothAtBothOfItsBounds) {
  for (const EndVelocity end : evaluated_again)
    for (const double load : {0.3, largest_corrected_load, largest_corrected_twice_load}) {
      Scene scene = bare_sheet(9, 9, 0.02, 0.05);
      scene.springs = SpringMaterial{.structural = 60, .shear = 3, .flexion = 0.5, .damping = 0};
      const double h = 1.98 / guaranteed_frequency(scene);
      scene.springs->damping = 1;
      scene.springs->damping = load / damping_load(scene, h);
      EXPECT_NEAR(damping_load(scene, h), load, 1e-12);
      DirectRun run(scene, "verlet");
      run.take_damping(end);
      std::mt19937 random(1);
      std::uniform_real_distribution<double> any(-1e-6, 1e-6);
      for (std::size_t i = 0; i < run.state.velocity.size(); ++i)  // across the sheet nothing damps
        run.state.velocity.set(i, {any(random), any(random), 0});
      const double before = kinetic_energy(run.system, run.state.velocity);
      run.advance(3000, h);
      EXPECT_LT(kinetic_energy(run.system, run.state.velocity), 0.1 * before) << load;
    }
}

TEST(CorrectedDamping, IsOfOrderTwoWithDampersDragSkinFrictionWindAndGusts) {
  for (const EndVelocity end : evaluated_again) expect_order_two(damped_smooth_scene(6, 6), end, true);
}

TEST(CorrectedDamping, IsOfOrderTwoInTheGeneralMethodToo) {
  for (const EndVelocity end : evaluated_again) expect_order_two(damped_smooth_scene(6, 6), end, false);
}

Scene material_in_wind() {
  Scene scene = builtin_scene("wind-denim");
  scene.cloth.rows = 7, scene.cloth.columns = 9;
  scene.deformation.reset();
  scene.material->stretch_damping = scene.material->bending_damping = 1e-6;
  return scene;
}

constexpr EndVelocity unsolved[] = {EndVelocity::predicted, EndVelocity::corrected,
                                    EndVelocity::corrected_twice};

TEST(UnsolvedDamping, IsTheSameInThePassAndInTheGeneralMethod) {
  for (const EndVelocity end : unsolved)
    for (const Scene& scene : {damped_smooth_scene(6, 6), material_in_wind()}) {
      const ClothSystem system = make_cloth(scene);
      ForceModel forces(scene, system);
      ASSERT_TRUE(FusedDampedVerlet::suits(forces));
      FusedDampedVerlet fused(end), in_parts(end);
      Verlet general(end);
      ClothState a = starting_state(system), b = a, c = a;
      Work work_a, work_b, work_c;
      const double h = 0.2 / guaranteed_frequency(scene);
      for (int n = 0; n < 200; ++n) {
        const StepTimes times{n * h, (n + 1) * h, h};
        const int evaluations = fused.step(forces, times, a, work_a).force_evaluations;
        EXPECT_EQ(evaluations, general.step(forces, times, b, work_b).force_evaluations);
        IntegratorReport report = in_parts.open_step(forces, times, c, work_c);
        in_parts.close_step(forces, times, c, work_c, report);
        EXPECT_EQ(evaluations, report.force_evaluations);
      }
      EXPECT_EQ(a, c);
      EXPECT_EQ(work_a.damping_loss, work_c.damping_loss);
      EXPECT_LT(rms_distance(a.position, b.position), 1e-13);
      EXPECT_LT(rms_distance(a.velocity, b.velocity), 1e-10);
      EXPECT_GT(rms_distance(a.position, system.start), 1e-6) << "nothing moved";
      EXPECT_NEAR(work_a.damping_loss, work_b.damping_loss, 1e-9 * std::abs(work_b.damping_loss));
      EXPECT_NEAR(work_a.air, work_b.air, 1e-9 * std::abs(work_b.air));
      EXPECT_GT(work_a.damping_loss, 0);
      EXPECT_NE(work_a.air, 0);
    }
}

/// `flag` with a damping that Verlet takes so.
Scene flag_damped(EndVelocity end, int rows, int columns) {
  Scene scene = builtin_scene("flag");
  scene.cloth.rows = rows, scene.cloth.columns = columns;
  scene.integrator.time_step = 1.2 / guaranteed_frequency(scene);
  const double load = end == EndVelocity::predicted ? 0.1 : end == EndVelocity::corrected ? 0.8 : 1.8;
  scene.springs->damping *= load / damping_load(scene, *scene.integrator.time_step);
  return scene;
}

TEST(UnsolvedDamping, HasTheSameBitsOnAnyNumberOfThreads) {
  for (const EndVelocity end : unsolved)
    for (const bool limited : {false, true}) {
      Scene scene = flag_damped(end, 61, 71);
      if (!limited) scene.deformation.reset();
      if (limited) scene.deformation = Deformation{.rate = 0.1};
      Simulation one(scene), three(scene);
      EXPECT_EQ(one.stepper(), (StepperKind{.fused = true, .end_velocity = end}));
      three.set_threads(3, ThreadUse::always);
      ASSERT_GT(three.threads(), 1);
      for (Simulation* simulation : {&one, &three}) ASSERT_FALSE(simulation->advance(150));
      EXPECT_EQ(one.state(), three.state()) << limited;
      EXPECT_EQ(one.measure().ledger.forces.damping_loss, three.measure().ledger.forces.damping_loss);
      EXPECT_EQ(one.measure().ledger.forces.air, three.measure().ledger.forces.air);
    }
}

std::ptrdiff_t held_springs(const Simulation& simulation) {
  const std::vector<double> tension = simulation.checkpoint().tension;
  return std::count_if(tension.begin(), tension.end(), [](double t) { return t > 0; });
}

TEST(UnsolvedDamping, GoesOnFromACheckpointToTheBit) {
  for (const EndVelocity end : unsolved) {
    const Scene scene = flag_damped(end, 25, 40);
    Simulation simulation(scene);
    EXPECT_EQ(simulation.stepper().end_velocity, end);
    const double taut = 0.46;  // s, when it hangs from its pole
    ASSERT_FALSE(simulation.advance(static_cast<std::int64_t>(taut / simulation.time_step())));
    for (int n = 0; n < 100 && held_springs(simulation) < 2; ++n) ASSERT_FALSE(simulation.advance(1));
    ASSERT_GT(held_springs(simulation), 1);
    const Checkpoint there = simulation.checkpoint();
    ASSERT_TRUE(SpringTensions(there.tension).is_few());
    ASSERT_FALSE(simulation.advance(300));
    const ClothState state = simulation.state();
    const double loss = simulation.measure().ledger.forces.damping_loss;
    Simulation other(scene);
    for (Simulation* again : {&simulation, &other}) {
      again->restore(there);
      ASSERT_FALSE(again->advance(300));
      EXPECT_EQ(again->state(), state);
      EXPECT_EQ(again->measure().ledger.forces.damping_loss, loss);
    }
  }
}

std::string integrate_text(const Scene& scene) {
  for (const StageInfo& stage : explain_stages(scene))
    if (stage.name == "integrate") return stage.reason;
  return "";
}

std::int64_t velocity_iterations(const Scene& scene) {
  Simulation simulation(scene);
  EXPECT_FALSE(simulation.advance(20));
  return simulation.count().velocity_iterations;
}

TEST(PredictedDamping, IsChosenWhereItsLimitAllowsAndExplainSaysWhy) {
  Scene scene = builtin_scene("flag");
  EXPECT_EQ(velocity_iterations(scene), 0);
  EXPECT_NE(integrate_text(scene).find("damping at the predicted velocity in the pass"), std::string::npos)
      << integrate_text(scene);
  const double h = 1.8 / guaranteed_frequency(scene);
  scene.integrator.time_step = h;
  scene.springs->damping *= 0.9 / damping_load(scene, h);
  EXPECT_GT(predicted_damping_load(scene, h), largest_predicted_load);
  EXPECT_EQ(velocity_iterations(scene), 0);
  EXPECT_NE(integrate_text(scene).find("damping evaluated twice"), std::string::npos)
      << integrate_text(scene);
  scene.springs->damping *= 2;
  EXPECT_GT(damping_load(scene, h), largest_corrected_load);
  EXPECT_EQ(velocity_iterations(scene), 0);
  EXPECT_NE(integrate_text(scene).find("damping evaluated three times"), std::string::npos)
      << integrate_text(scene);
  scene.springs->damping *= 5;
  EXPECT_GT(damping_load(scene, h), largest_corrected_twice_load);
  EXPECT_GT(velocity_iterations(scene), 0);
  EXPECT_NE(integrate_text(scene).find("conjugate gradients"), std::string::npos) << integrate_text(scene);
  scene.springs->damping = 0, scene.air.reset(), scene.damping = 0.001;
  EXPECT_NE(integrate_text(scene).find("for each particle by itself"), std::string::npos)
      << integrate_text(scene);
}

TEST(PredictedDamping, IsGivenUpWhileAHandPullsTooHardForIt) {
  Scene scene = builtin_scene("wind");
  const double h = *resolved_time_step(scene);
  for (int k = 0; k < 20; ++k) scene.springs->damping *= 0.949 / predicted_damping_load(scene, h);
  scene.integrator.time_step = h;
  Simulation simulation(scene);
  EXPECT_EQ(simulation.stepper().end_velocity, EndVelocity::predicted);
  simulation.set_pull(Pull{.particle = 500, .target = {0, 0.5, 0.2}});
  EXPECT_EQ(simulation.stepper().end_velocity, EndVelocity::corrected);
  ASSERT_FALSE(simulation.advance(20));
  simulation.set_pull(std::nullopt);
  EXPECT_EQ(simulation.stepper().end_velocity, EndVelocity::predicted);
}

/// (h^2 K + 4 h D)/(4 m) of random shapes and motions, by the forces' own differences.
TEST(PredictedDampingLoad, IsAboveTheRayleighQuotientOfEveryShape) {
  const Scene scene = damped_smooth_scene(6, 6);
  const double h = 0.01, bound = predicted_damping_load(scene, h);
  const ClothSystem system = make_cloth(scene);
  ForceModel forces(scene, system);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  double largest = 0;
  for (int shape = 0; shape < 20; ++shape) {
    Vec3Field x = system.start, d(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) x.add(i, 0.3 * Vec3(any(random), any(random), any(random)));
    for (std::size_t i = 0; i < x.size(); ++i) d.set(i, Vec3(any(random), any(random), any(random)));
    for (int power = 0; power < 60; ++power) {  // towards the largest eigenvalue
      double square = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        if (system.pinned[i]) d.set(i, Vec3::Zero());
      for (const double value : d.flat()) square += value * value;
      for (double& value : d.flat()) value /= std::sqrt(square);
      const double eps = 1e-6;
      Vec3Field ahead = x, behind = x, f_ahead(x.size()), f_behind(x.size()), still(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) ahead.add(i, eps * d[i]), behind.add(i, -eps * d[i]);
      forces.update(ahead, 0);
      f_ahead = forces.position_force();
      forces.update(behind, 0);
      f_behind = forces.position_force();
      forces.update(x, 0);
      Vec3Field damped(x.size());
      forces.force(x, d, damped);  // p - D d
      Vec3Field product(x.size());
      double quotient = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec3 k = (f_behind[i] - f_ahead[i]) / (2 * eps), c = forces.position_force()[i] - damped[i];
        const Vec3 both = (h * h * k + 4 * h * c) / (4 * system.mass[i]);
        quotient += both.dot(d[i]);
        product.set(i, both);
      }
      largest = std::max(largest, quotient);
      d = product;
    }
  }
  EXPECT_LE(largest, bound * (1 + 1e-6));
  EXPECT_GT(largest, 0.4 * bound) << "the bound says little";
}

}  // namespace
}  // namespace cloth::test::predicted_damping_test
