// What a free cloth keeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "integrators/registry.h"
#include "measure/energy.h"
#include "measure/stability_limit.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::invariants_test {
namespace {

constexpr double horizon = 2;  // s

Scene free_sheet() {
  Scene scene = bare_sheet(6, 6, 0.2, 0.01);
  scene.springs = SpringMaterial{.structural = 20, .shear = 10, .flexion = 5, .damping = 0};
  return scene;
}

/// A free sheet run for the horizon at omega h = w.
struct FreeRun {
  FreeRun(const std::string& method, double w, double spring_damping = 0) {
    Scene scene = free_sheet();
    scene.springs->damping = spring_damping;
    const double omega = largest_frequency(scene.cloth, *scene.springs);
    const int steps = static_cast<int>(std::ceil(horizon * omega / w));
    DirectRun run(scene, exactly(method, {}, 1.5 * w));
    run.state = waving_state(run.system, 0.05, 0.3);
    const auto energy = [&] { return measure_energy(run.system, Vec3::Zero(), run.state).total(); };
    const double first_energy = energy();
    const Vec3 first_momentum = momentum(run.system, run.state);
    const Vec3 first_angular = angular_momentum(run.system, run.state);
    for (int n = 0; n < steps; ++n) {
      run.advance(1, horizon / steps);
      const double error = energy() / first_energy - 1;
      largest_energy_error = std::max(largest_energy_error, std::abs(error));
      if (n < steps / 2) early_energy_error = largest_energy_error;
      last_energy_error = error;
    }
    momentum_error = (momentum(run.system, run.state) - first_momentum).norm() / first_momentum.norm();
    angular_error = (angular_momentum(run.system, run.state) - first_angular).norm() / first_angular.norm();
  }
  double momentum_error = 0, angular_error = 0;
  double largest_energy_error = 0, early_energy_error = 0, last_energy_error = 0;
};

TEST(Momentum, IsKeptByEveryMethodWithAndWithoutSpringDamping) {
  for (const std::string& method : integrator_names())
    for (const double damping : {0.0, 0.005})
      EXPECT_LE(FreeRun(method, 0.1, damping).momentum_error, 1e-11) << method;
}

/// The invariants of a method.
enum class Kept { exactly, to_order };
struct Invariants {
  Kept angular_momentum;
  double angular_order;  ///< of what is lost of it
  double energy_order;
  bool energy_drifts;  ///< falls, or else swings
};
const std::map<std::string, Invariants> invariants{{"semi-implicit-euler", {Kept::exactly, 0, 1, false}},
                                                   {"verlet", {Kept::exactly, 0, 2, false}},
                                                   {"rk4", {Kept::to_order, 4, 5, true}},
                                                   {"dormand-prince", {Kept::to_order, 5, 5, true}},
                                                   {"implicit-euler", {Kept::to_order, 1, 1, true}},
                                                   {"implicit-midpoint", {Kept::exactly, 0, 2, false}},
                                                   {"bdf2", {Kept::to_order, 2, 3, true}},
                                                   {"projective", {Kept::to_order, 1, 1, true}},
                                                   {"xpbd", {Kept::to_order, 1, 1, true}},
                                                   {"vbd", {Kept::to_order, 1, 1, true}}};

std::vector<std::string> methods_where(const std::function<bool(const Invariants&)>& chosen) {
  std::vector<std::string> methods;
  for (const std::string& method : integrator_names())
    if (const auto found = invariants.find(method); found != invariants.end() && chosen(found->second))
      methods.push_back(method);
  return methods;
}

TEST(AngularMomentum, IsKeptExactlyByTheSymplecticMethods) {
  for (const std::string& method : methods_where([](auto& i) { return i.angular_momentum == Kept::exactly; }))
    for (const double w : {0.5, 0.25}) EXPECT_LE(FreeRun(method, w).angular_error, 1e-11) << method;
}

TEST(AngularMomentum, OfTheOthersIsKeptBetterTheShorterTheStep) {
  for (const std::string& method :
       methods_where([](auto& i) { return i.angular_momentum != Kept::exactly; })) {
    const double coarse = FreeRun(method, 0.5).angular_error, middle = FreeRun(method, 0.25).angular_error;
    const double fine = FreeRun(method, 0.125).angular_error;
    std::printf("%s dL/L: %.2e %.2e %.2e\n", method.c_str(), coarse, middle, fine);
    const double order = invariants.at(method).angular_order;
    EXPECT_LE(coarse, order > 2 ? 1e-4 : 0.2) << method;
    // Orders 1 and 2 lose fast motions at these steps, and show their order at far shorter ones only.
    const double gained = order > 2 ? 0.85 * order : 0.5;
    EXPECT_GE(std::log2(coarse / middle), gained) << method;
    EXPECT_GE(std::log2(middle / fine), gained) << method;
  }
}

TEST(AngularMomentum, IsKeptBySpringDampingAtTheMethodsOrder) {
  EXPECT_LE(FreeRun("verlet", 0.1, 0.005).angular_error, 1e-3);
  EXPECT_LE(FreeRun("rk4", 0.1, 0.005).angular_error, 1e-8);
}

/// The energy swings at the method's order and does not drift: the second half is no worse than the first.
void expect_energy_swings(const std::string& method, int order) {
  const FreeRun coarse(method, 0.5), middle(method, 0.25), fine(method, 0.125);
  std::printf("%s energy: %.2e %.2e %.2e\n", method.c_str(), coarse.largest_energy_error,
              middle.largest_energy_error, fine.largest_energy_error);
  EXPECT_NEAR(std::log2(middle.largest_energy_error / fine.largest_energy_error), order, 0.3) << method;
  for (const FreeRun* run : {&coarse, &middle, &fine})
    EXPECT_LE(run->largest_energy_error, 1.5 * run->early_energy_error) << method;
}

TEST(Energy, OfTheSymplecticMethodsSwingsAtTheirOrderWithoutDrift) {
  for (const std::string& method : methods_where([](auto& i) { return !i.energy_drifts; }))
    expect_energy_swings(method, static_cast<int>(invariants.at(method).energy_order));
}

TEST(Energy, OfTheOthersFallsAtTheirOrder) {
  for (const std::string& method : methods_where([](auto& i) { return i.energy_drifts; })) {
    const double order = invariants.at(method).energy_order;
    const double w = order > 4 ? 0.5 : 0.1;
    const double coarse = FreeRun(method, w).last_energy_error;
    const double fine = FreeRun(method, w / 2).last_energy_error;
    std::printf("%s energy: %.2e %.2e\n", method.c_str(), coarse, fine);
    EXPECT_LT(coarse, 0) << method;
    EXPECT_LT(fine, 0) << method;
    // Those of low order have lost nearly all of the fast motions at either step.
    EXPECT_GE(std::log2(coarse / fine), order > 4 ? order - 0.5 : 0.2) << method;
    EXPECT_LE(std::log2(coarse / fine), order + 0.5) << method;
  }
}

TEST(Energy, OfExplicitEulerGrows) {
  EXPECT_GT(FreeRun("explicit-euler", 0.02).last_energy_error, 0.01);
}

TEST(SpringDamping, OnlyTakesEnergy) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    const double last = FreeRun(method, 0.05, 0.01).last_energy_error;
    EXPECT_LT(last, -0.01) << method;
    EXPECT_GT(last, -1) << method;
  }
}

}  // namespace
}  // namespace cloth::test::invariants_test
