// The deformation rate takes energy, as an impact without bounce does, and no method makes any by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth::test::limited_energy_test {
namespace {

/// What became of the energy in a run.
struct Account {
  double rise = 0;         ///< J: the most that total energy less all works but the limiter's ever rose
  double exchanged = 0;    ///< J: the largest of the air's work, kinetic and gravity energy
  double worst_error = 0;  ///< J, of the ledger
};

Account account_of(const Scene& scene) {
  Simulation simulation(scene);
  Account account;
  double lowest = 0;
  while (simulation.time() < scene.duration) {
    const auto divergence = simulation.step();
    EXPECT_FALSE(divergence) << describe(*divergence);
    if (divergence) break;
    const Measurement m = simulation.measure();
    const EnergyLedger& ledger = m.ledger;
    const double unexplained = m.energy.total() - ledger.initial - (ledger.entered() - ledger.limiter);
    lowest = std::min(lowest, unexplained);
    account.rise = std::max(account.rise, unexplained - lowest);
    account.worst_error = std::max(account.worst_error, std::abs(m.energy_error()));
    account.exchanged = std::max(
        {account.exchanged, std::abs(ledger.forces.air), m.energy.kinetic, std::abs(m.energy.gravity)});
  }
  return account;
}

/// The built-in `wind` on a coarse grid, at a part of the method's longest stable step, or of Verlet's for
/// methods without one.
Scene gusty(const std::string& method, int side, double rate, double part) {
  Scene scene = builtin_scene("wind");
  scene.cloth.rows = scene.cloth.columns = side;
  scene.deformation->rate = rate;
  scene.integrator.method = method;
  const double limit = stable_step(method, scene).value();
  scene.integrator.time_step = part * (std::isfinite(limit) ? limit : stable_step("verlet", scene).value());
  scene.duration = 0.25;
  return scene;
}

std::vector<std::string> methods() {
  std::vector<std::string> names = integrator_names();
  names.erase(std::remove(names.begin(), names.end(), "explicit-euler"), names.end());  // makes its own
  return names;
}

class EveryMethodWithARate : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryMethodWithARate, MakesNoEnergyByTheRateUpToItsLongestStep) {
  double worst = 0;
  for (const double rate : {0.1, 0.01, 0.001})
    for (const double part : {0.3, 0.8, 0.95}) {
      const Account account = account_of(gusty(GetParam(), 13, rate, part));
      EXPECT_GT(account.exchanged, 0.05);
      EXPECT_LE(account.rise, 0.05 * account.exchanged) << "rate " << rate << ", " << part << " of the limit";
      worst = std::max(worst, account.rise / account.exchanged);
    }
  std::printf("%s: at most %.2g %% of the energy exchanged\n", GetParam().c_str(), 100 * worst);
}

INSTANTIATE_TEST_SUITE_P(Of, EveryMethodWithARate, ::testing::ValuesIn(methods()), [](const auto& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(VerletWithARate, MakesNoEnergyOnAFinerClothEither) {
  for (const double rate : {0.1, 0.01}) {
    const Account account = account_of(gusty("verlet", 33, rate, 0.8));
    EXPECT_LE(account.rise, 0.01 * account.exchanged) << rate;
  }
}

TEST(XpbdWithARate, MakesNoEnergyAtTheAutomaticStep) {
  for (const char* name : {"flag", "wind"})
    for (const double rate : {0.1, 0.03, 0.01, 0.001}) {
      Scene scene = builtin_scene(name);
      scene.deformation->rate = rate;
      scene.integrator = {.method = "xpbd"};
      scene.integrator.time_step = resolved_time_step(scene).value();
      scene.duration = 0.5;
      const Account account = account_of(scene);
      EXPECT_GT(account.exchanged, 0.5);
      EXPECT_LE(account.rise, 0.1 * account.exchanged) << name << " at " << rate;  // 0.07 without a rate
    }
}

/// What a solve leaves within the tolerance becomes speed, (what is left)/h, and that is not to heat the
/// cloth.
TEST(AShortStep, OfALimitedClothMakesNoMoreEnergyThanALongOne) {
  for (const char* method : {"verlet", "semi-implicit-euler", "xpbd"})
    for (const double rate : {0.01, 0.001}) {
      Scene scene = gusty(method, 13, rate, 0);
      scene.integrator.time_step = std::string(method) == "xpbd" ? 3e-4 : 3e-5;  // ten substeps
      scene.duration = 0.15;
      const Account account = account_of(scene);
      EXPECT_LE(account.rise, 0.01 * account.exchanged) << method << " at " << rate;
    }
}

/// Methods that divide their steps must not follow springs far beyond the rate before the limiter acts.
TEST(TheAutomaticStep, OfAMethodWithInnerStepsLimitsTheSameMotion) {
  const auto end_of = [](const char* method) {
    Scene scene = gusty(method, 33, 0.01, 0);
    scene.integrator.time_step.reset();
    if (std::string(method) == "xpbd") scene.integrator.xpbd_iterations = 10;
    scene.integrator.time_step = resolved_time_step(scene).value();
    Simulation simulation(scene);
    while (simulation.time() < 0.2 - 1e-9) EXPECT_FALSE(simulation.step());
    EXPECT_LE(simulation.measure().ledger.limiter, 0) << method;
    return simulation.measure().energy;
  };
  const Energy right = end_of("verlet");
  for (const char* method : {"dormand-prince", "xpbd"}) {
    const Energy found = end_of(method);
    EXPECT_NEAR(found.kinetic, right.kinetic, 0.02 * right.kinetic) << method;
    EXPECT_NEAR(found.elastic, right.elastic, 0.02 * right.kinetic) << method;
  }
}

/// The limiter's impulses act on the velocity with which the step began: so booked, what is left is the
/// bounded swing of Verlet's own energy.
TEST(VerletWithARate, AccountsForItsEnergyAtTheLongestAutomaticStep) {
  for (const char* name : {"wind", "corners-shear"})
    for (const double rate : {0.1, 0.01}) {
      Scene scene = builtin_scene(name);
      scene.deformation->rate = rate;
      scene.integrator.time_step.reset();
      scene.integrator.time_step = resolved_time_step(scene).value();
      scene.duration = 0.5;
      const Account account = account_of(scene);
      EXPECT_LE(account.worst_error, 0.02 * account.exchanged) << name << " at " << rate;
    }
}

/// Held tensions and the springs that they answer cancel from kick to kick: damping has not worked with them.
TEST(VerletWithARate, AccountsForDampingOnAFineClothToo) {
  for (const auto& [side, rate, damping] : {std::tuple{49, 0.01, 0.01}, {33, 0.001, 0.02}}) {
    Scene scene = gusty("verlet", side, rate, 0);
    scene.springs->damping = damping;
    scene.air->drag = 0.01;
    scene.integrator.time_step.reset();
    scene.integrator.time_step = resolved_time_step(scene).value();
    scene.duration = 0.15;
    const Account account = account_of(scene);
    EXPECT_LE(account.worst_error, 0.003 * account.exchanged) << side << " at " << rate;
  }
}

/// What the air takes is the air's work: no loss by damping is booked that no column shows.
TEST(VerletWithARate, BooksNoLossByDampingWhereOnlyTheAirDamps) {
  Scene scene = gusty("verlet", 17, 0.01, 0.8);
  scene.springs->damping = 0;
  scene.damping.reset();
  Simulation simulation(scene);
  int taut = 0;
  while (simulation.time() < 0.1) {
    ASSERT_FALSE(simulation.step());
    taut += simulation.last_limit().sweeps > 0 ? 1 : 0;
  }
  EXPECT_GT(taut, 0);
  EXPECT_EQ(simulation.measure().ledger.forces.damping_loss, 0);
}

/// Contact answers the closing kick of held tensions: their work is counted with the velocity after it.
TEST(VerletWithARate, AccountsForItsEnergyOnATableToo) {
  for (const bool continuous : {false, true}) {
    Scene scene = builtin_scene("tablecloth");
    scene.cloth.rows = scene.cloth.columns = 25;
    scene.deformation->rate = 0.01;
    if (continuous) scene.contact.emplace();
    scene.integrator.time_step = resolved_time_step(scene).value();
    scene.duration = 0.5;
    const Account account = account_of(scene);
    EXPECT_LE(account.worst_error, 0.1 * account.exchanged) << (continuous ? "continuous" : "discrete");
  }
}

/// With one mass changed in its last digits no pass takes the cloth.
Simulation held_curtain(bool general) {
  Scene scene = builtin_scene("curtain");
  scene.cloth.rows = 52, scene.cloth.columns = 65;
  return Simulation(scene, [general](ClothSystem& system, ClothState&) {
    if (general) system.mass.back() *= 1 + 1e-15, system.inverse_mass.back() = 1 / system.mass.back();
  });
}

TEST(DeformationRate, HoldsSpringsInThePassOfSemiImplicitEulerAsInTheGeneralMethod) {
  Simulation run = held_curtain(false), general = held_curtain(true);
  ASSERT_FALSE(run.advance(230));
  ASSERT_FALSE(general.advance(230));
  double most = 0;
  for (std::size_t i = 0; i < run.state().position.size(); ++i)
    most = std::max(most, (run.state().position[i] - general.state().position[i]).norm());
  EXPECT_LE(most, 1e-12);
  EXPECT_NEAR(run.measure().energy_error(), general.measure().energy_error(), 1e-10);
  const std::vector<double> tension = run.checkpoint().tension;
  EXPECT_TRUE(std::any_of(tension.begin(), tension.end(), [](double t) { return t > 0; })) << "none is held";
}

}  // namespace
}  // namespace cloth::test::limited_energy_test
