// Observed orders (numerics.md 4a): a smooth cloth with viscous damping, drag along the normals, wind and
// gusts, hung by two corners; the step is halved five times and T is hit exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "integrators/registry.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test {
namespace {

constexpr double horizon = 0.4;  // s
constexpr int halvings = 5;

ClothState solve(const Scene& scene, const std::string& method, int steps) {
  DirectRun run(scene, method);
  run.advance(steps, horizon / steps);
  return run.state;
}

/// A run of Runge-Kutta 4 at a step so fine that halving it moves the answer by `uncertainty` only.
struct Reference {
  explicit Reference(const Scene& scene) : state(solve(scene, "rk4", 12800)) {
    const ClothState coarser = solve(scene, "rk4", 6400);
    position_uncertainty = rms_distance(coarser.position, state.position);
    velocity_uncertainty = rms_distance(coarser.velocity, state.velocity);
  }
  ClothState state;
  double position_uncertainty = 0, velocity_uncertainty = 0;
};

/// The first number of steps of each method, in the range where its error is asymptotic.
int first_steps(const std::string& method) {
  const std::map<std::string, int> steps{
      {"explicit-euler", 800}, {"semi-implicit-euler", 400}, {"verlet", 100}, {"rk4", 50}};
  return steps.at(method);
}

std::vector<double> orders_of(const std::vector<double>& errors) {
  std::vector<double> orders;
  for (std::size_t k = 1; k < errors.size(); ++k) orders.push_back(std::log2(errors[k - 1] / errors[k]));
  return orders;
}

/// The last three observed orders lie around the nominal one: bounded from both sides.
void expect_order(const std::vector<double>& errors, int order, double uncertainty, const std::string& what) {
  const double slack = order >= 4 ? 0.2 : 0.1;
  const std::vector<double> orders = orders_of(errors);
  std::string list;
  for (const double p : orders) list += " " + std::to_string(p);
  std::printf("%s: error %.2e, orders%s\n", what.c_str(), errors.back(), list.c_str());
  for (std::size_t k = orders.size() - 3; k < orders.size(); ++k)
    EXPECT_NEAR(orders[k], order, slack) << what;
  EXPECT_GT(errors.back(), 10 * uncertainty) << what;
}

void expect_observed_order(const Scene& scene, const std::string& method) {
  const Reference reference(scene);
  std::vector<double> position, velocity;
  for (int k = 0; k <= halvings; ++k) {
    const ClothState state = solve(scene, method, first_steps(method) << k);
    position.push_back(rms_distance(state.position, reference.state.position));
    velocity.push_back(rms_distance(state.velocity, reference.state.velocity));
  }
  const int order = facts_of(method).order;
  expect_order(position, order, reference.position_uncertainty, method + " position");
  expect_order(velocity, order, reference.velocity_uncertainty, method + " velocity");
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
double ledger_error(Scene scene, const std::string& method, int steps) {
  scene.integrator = {method, horizon / steps};
  Simulation simulation(scene);
  for (int n = 0; n < steps; ++n) simulation.step();
  return std::abs(simulation.measure().energy_error());
}

TEST_P(ObservedOrder, IsAlsoThatOfTheEnergyLedger) {
  const int first = GetParam() == "rk4" ? 100 : first_steps(GetParam());  // asymptotic later than positions
  std::vector<double> errors;
  for (int k = 0; k <= halvings; ++k)
    errors.push_back(ledger_error(with_spring_damping(), GetParam(), first << k));
  expect_order(errors, facts_of(GetParam()).order, 1e-15, GetParam() + " ledger");
}

std::string test_name(const ::testing::TestParamInfo<std::string>& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Of, ObservedOrder, ::testing::ValuesIn(integrator_names()), test_name);

TEST(Verlet, NeedsOneForceEvaluationAStepWithEveryDamping) {
  DirectRun run(with_spring_damping(), "verlet");
  run.advance(500, horizon / 500);
  EXPECT_EQ(run.force_evaluations, 501);  // and the one that the first step starts from
}

TEST(EveryMethod, NeedsAsManyForceEvaluationsAsItsFactsSay) {
  for (const MethodFacts& facts : integrator_facts()) {
    DirectRun run(smooth_scene(4, 4), facts.name);
    run.advance(100, 1e-4);
    EXPECT_EQ(run.force_evaluations, 100 * facts.evaluations_per_step + (facts.name == "verlet" ? 1 : 0));
  }
}

}  // namespace
}  // namespace cloth::test
