// Observed orders: a smooth cloth with viscous damping, drag along the normals, wind and
// gusts, hung by two corners; the step is halved five times and T is hit exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"
#include "support/test_names.h"

namespace cloth::test::order_test {
namespace {

constexpr double horizon = 0.4;  // s

/// The step counts at which a method's error is asymptotic, and how near to the nominal order it then is.
struct Ladder {
  int first = 100;
  int halvings = 5;
  double slack = 0.1;
  double time = horizon;   // s
  std::size_t judged = 3;  // last orders; of order 5 fewer fit between the first asymptotic step and rounding
};

/// Methods that damp fast motions by themselves are asymptotic only where the fastest one is resolved finely:
/// they get a shorter time.
Ladder ladder_of(const std::string& method) {
  const Ladder damped{.first = 200, .halvings = 3, .time = 0.1};
  const std::map<std::string, Ladder> ladders{
      {"explicit-euler", {.first = 800}},
      {"semi-implicit-euler", {.first = 400}},
      {"verlet", {}},
      {"rk4", {.first = 50, .slack = 0.2}},
      {"dormand-prince", {.first = 100, .halvings = 2, .slack = 0.35, .judged = 2}},
      {"implicit-euler", damped},
      {"implicit-midpoint", {.first = 100, .halvings = 4, .time = 0.1}},
      {"bdf2", {.first = 100, .halvings = 4, .time = 0.1}},
      {"projective", damped},
      {"xpbd", damped},
      {"vbd", damped}};
  return ladders.at(method);
}

/// The method with as many local iterations as its step needs, forces of dampers included.
IntegratorChoice resolved(const Scene& scene, const std::string& method, double step) {
  return exactly(method, step, 2 * guaranteed_frequency(scene) * step);
}

ClothState solve(const Scene& scene, const std::string& method, int steps, double time) {
  DirectRun run(scene, resolved(scene, method, time / steps));
  run.advance(steps, time / steps);
  return run.state;
}

/// A run of Runge-Kutta 4 at a step so fine that halving it moves the answer by `uncertainty` only.
struct Reference {
  explicit Reference(const Scene& scene, double time = horizon) : state(solve(scene, "rk4", 12800, time)) {
    const ClothState coarser = solve(scene, "rk4", 6400, time);
    position_uncertainty = rms_distance(coarser.position, state.position);
    velocity_uncertainty = rms_distance(coarser.velocity, state.velocity);
  }
  ClothState state;
  double position_uncertainty = 0, velocity_uncertainty = 0;
};

std::vector<double> orders_of(const std::vector<double>& errors) {
  std::vector<double> orders;
  for (std::size_t k = 1; k < errors.size(); ++k) orders.push_back(std::log2(errors[k - 1] / errors[k]));
  return orders;
}

/// The last observed orders lie around the nominal one: bounded from both sides.
void expect_order(const std::vector<double>& errors, int order, const Ladder& ladder, double uncertainty,
                  const std::string& what) {
  const std::vector<double> orders = orders_of(errors);
  std::string list;
  for (const double p : orders) list += " " + std::to_string(p);
  std::printf("%s: error %.2e, orders%s\n", what.c_str(), errors.back(), list.c_str());
  for (std::size_t k = orders.size() - ladder.judged; k < orders.size(); ++k)
    EXPECT_NEAR(orders[k], order, ladder.slack) << what;
  EXPECT_GT(errors.back(), 10 * uncertainty) << what;
}

void expect_observed_order(const Scene& scene, const std::string& method) {
  const Ladder ladder = ladder_of(method);
  const Reference reference(scene, ladder.time);
  std::vector<double> position, velocity;
  for (int k = 0; k <= ladder.halvings; ++k) {
    const ClothState state = solve(scene, method, ladder.first << k, ladder.time);
    position.push_back(rms_distance(state.position, reference.state.position));
    velocity.push_back(rms_distance(state.velocity, reference.state.velocity));
  }
  const int order = facts_of(method).order;
  expect_order(position, order, ladder, reference.position_uncertainty, method + " position");
  expect_order(velocity, order, ladder, reference.velocity_uncertainty, method + " velocity");
}

Scene with_spring_damping() {
  Scene scene = smooth_scene(6, 6);
  scene.springs->damping = 0.05;
  return scene;
}

class ObservedOrder : public ::testing::TestWithParam<std::string> {};

TEST_P(ObservedOrder, IsTheNominalOneWithDampingDragWindAndGusts) {
  expect_observed_order(smooth_scene(6, 6), GetParam());
}

TEST_P(ObservedOrder, IsTheNominalOneWithSpringDampingToo) {
  expect_observed_order(with_spring_damping(), GetParam());
}

/// The ledger's error at the horizon, in J, through the loop.
double ledger_error(Scene scene, const std::string& method, int steps, double time) {
  scene.integrator = resolved(scene, method, time / steps);
  Simulation simulation(scene);
  for (int n = 0; n < steps; ++n) simulation.step();
  return std::abs(simulation.measure().energy_error());
}

TEST_P(ObservedOrder, IsAlsoThatOfTheEnergyLedger) {
  Ladder ladder = ladder_of(GetParam());
  if (GetParam() == "rk4") ladder.first = 100;  // asymptotic later than positions
  if (GetParam() == "bdf2") ladder.first = 800, ladder.halvings = 3;
  if (GetParam() == "dormand-prince") ladder.first = 200, ladder.slack = 0.5;
  std::vector<double> errors;
  for (int k = 0; k <= ladder.halvings; ++k)
    errors.push_back(ledger_error(with_spring_damping(), GetParam(), ladder.first << k, ladder.time));
  expect_order(errors, facts_of(GetParam()).order, ladder, 1e-15, GetParam() + " ledger");
}

INSTANTIATE_TEST_SUITE_P(Of, ObservedOrder, ::testing::ValuesIn(integrator_names()), test_name);

TEST(Verlet, NeedsOneForceEvaluationAStepWithEveryDamping) {
  DirectRun run(with_spring_damping(), "verlet");
  run.advance(500, horizon / 500);
  EXPECT_EQ(run.force_evaluations, 501);  // and the one that the first step starts from
}

TEST(EveryMethod, NeedsAsManyForceEvaluationsAsItsFactsSay) {
  for (const MethodFacts& facts : integrator_facts()) {
    if (facts.evaluations_per_step == 0) continue;  // as many as needed
    DirectRun run(smooth_scene(4, 4), facts.name);
    run.advance(100, 1e-4);
    EXPECT_EQ(run.force_evaluations, 100 * facts.evaluations_per_step + (facts.keeps_force ? 1 : 0));
  }
}

TEST(DormandPrince, NeedsSixForceEvaluationsAStepOfFixedLength) {
  DirectRun run(smooth_scene(4, 4), "dormand-prince");
  run.advance(100, 1e-4);
  EXPECT_EQ(run.force_evaluations, 601);  // and the one that the first step starts from
  EXPECT_EQ(run.inner_steps, 100);
}

}  // namespace
}  // namespace cloth::test::order_test
