// Dampers along springs that are stiff for the step, h D many times m, under contact: what contact stops is
// damped as in a short step, and the ledger closes.
#include <gtest/gtest.h>

#include <algorithm>

#include "integrators/end_velocity.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "simulation/time_step.h"
#include "support/contact_check.h"
#include "support/random.h"

namespace cloth::test::contact_dampers_test {
namespace {

/// With dampers for which Verlet solves at the longest stable step.
Scene stiffly_damped(const std::string& name, double part, double damping) {
  Scene scene = coarser(builtin_scene(name), part);
  scene.springs->damping = damping;
  scene.integrator = {.method = "verlet"};
  scene.integrator.time_step = resolved_time_step(scene).value();
  return scene;
}

struct Impact {
  std::string name;
  double part = 1;       ///< of the particles along an edge
  double damping = 0.5;  ///< N s/m
  double time = 0.4;     ///< s
  bool by_particle = false;
};

class StiffDampers : public ::testing::TestWithParam<Impact> {};

TEST_P(StiffDampers, KeepTheLedgerUnderContact) {
  const auto& [name, part, damping, time, by_particle] = GetParam();
  const Scene scene = stiffly_damped(name, part, damping);
  ASSERT_EQ(Simulation(scene).stepper().end_velocity, EndVelocity::solved);
  const ContactLedger ledger = ledger_run(scene, {}, time);
  ASSERT_FALSE(ledger.stop) << describe(*ledger.stop);
  EXPECT_LT(ledger.work, 0) << "nothing was touched";
  EXPECT_LT(ledger.account.share(), by_particle ? 0.04 : 0.01);
}

struct Stretch {
  double largest = 0, energy = 0;  ///< strain; J at the end
};

Stretch stretch_of(Scene scene, double step, double time) {
  scene.integrator.time_step = step;
  Simulation simulation(scene);
  Stretch stretch;
  while (simulation.time() + 0.5 * step < time) {
    if (simulation.step()) return {infinity, infinity};
    stretch.largest = std::max(stretch.largest, simulation.measure().strain.maximum());
  }
  stretch.energy = simulation.measure().energy.total();
  return stretch;
}

TEST_P(StiffDampers, StretchWhatContactStopsAsInShortSteps) {
  const auto& [name, part, damping, time, by_particle] = GetParam();
  const Scene scene = stiffly_damped(name, part, damping);
  const double step = *scene.integrator.time_step;
  const double load = damping_load(scene, step);
  ASSERT_GT(load, 2);
  const Stretch found = stretch_of(scene, step, time), right = stretch_of(scene, step / load, time);
  EXPECT_LT(found.largest, 2 * right.largest);
  EXPECT_NEAR(found.energy, right.energy, (by_particle ? 0.1 : 0.05) * std::abs(right.energy));
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, StiffDampers,
                         ::testing::Values(Impact{.name = "ball", .by_particle = true},
                                           Impact{.name = "cube", .by_particle = true},
                                           Impact{.name = "tablecloth", .by_particle = true},
                                           Impact{"corner", 0.5}, Impact{"spikes", 0.5}, Impact{"twist", 0.5},
                                           Impact{"bunny", 0.5}, Impact{"fold", 0.5, 0.5, 0.3}),
                         [](const auto& tested) { return tested.param.name; });

/// With dampers so stiff these diverged, at a step that is stable in every shape without contact.
TEST(VeryStiffDampers, LetAClothLandAtTheLongestStableStep) {
  for (const Impact& impact :
       {Impact{"rectangle", 1, 3}, Impact{"spikes", 1, 5}, Impact{"twist", 1, 20, 0.2}}) {
    const Scene scene = stiffly_damped(impact.name, impact.part, impact.damping);
    const ContactLedger ledger = ledger_run(scene, {}, impact.time);
    EXPECT_FALSE(ledger.stop) << impact.name << ": " << describe(*ledger.stop);
    EXPECT_LT(ledger.account.share(), 0.02) << impact.name;
    EXPECT_LT(ledger.work, 0) << impact.name;
  }
}

/// The velocity at which a step begins its damping is not that of its state.
TEST(StiffDampersUnderContact, GoOnFromACheckpointToTheBit) {
  for (const char* name : {"ball", "spikes", "fold", "dormand-prince", "rk4"}) {
    const bool by_stages = name == std::string("rk4") || name == std::string("dormand-prince");
    Scene scene = stiffly_damped(by_stages ? "corner" : name, 0.5, by_stages ? 0.1 : 0.5);
    if (by_stages) scene.integrator.method = name;
    Simulation simulation(scene);
    while (simulation.last_contact().contacts == 0) ASSERT_FALSE(simulation.step());
    ASSERT_FALSE(simulation.advance(5));
    const Checkpoint there = simulation.checkpoint();
    ASSERT_FALSE(simulation.advance(60));
    const ClothState state = simulation.state();
    const double loss = simulation.measure().ledger.forces.damping_loss;
    Simulation other(scene);
    for (Simulation* again : {&simulation, &other}) {
      again->restore(there);
      ASSERT_FALSE(again->advance(60));
      EXPECT_EQ(again->state(), state) << name;
      EXPECT_EQ(again->measure().ledger.forces.damping_loss, loss) << name;
    }
  }
}

/// A particle that contact holds moves within a step of a Runge-Kutta method, and dampers with it, as it has
/// not once contact has moved it back: up to 45 % of the energy exchanged were booked too much.
TEST(DampersUnderRungeKutta, KeepTheLedgerUnderContact) {
  for (const char* method : {"dormand-prince", "rk4"})
    for (const char* name : {"corner", "tablecloth"})
      for (const double damping : {0.02, 0.1}) {
        Scene scene = builtin_scene(name);
        scene.springs->damping = damping;
        scene.integrator = {.method = method};
        scene.integrator.time_step =
            method == std::string("rk4") ? resolved_time_step(scene).value() : 0.01;
        const ContactLedger ledger = ledger_run(scene, {}, 0.4);
        EXPECT_LT(ledger.account.share(), 0.045) << method << ", " << name << ", " << damping << " N s/m";
      }
}

/// Without contact too: velocities that no solution of a step has, here random ones, lose at once what the
/// dampers take of them, which is a small part of h times the power at the beginning.
TEST(StiffDampersAlone, TakeFromRandomVelocitiesTheEnergyThatIsLost) {
  Scene scene = stiffly_damped("corners-free", 0.5, 2);
  scene.deformation.reset(), scene.air.reset(), scene.damping.reset();
  scene.springs->structural = scene.springs->shear = scene.springs->flexion = 1e-9;
  Random random;
  Simulation simulation(scene, [&](const ClothSystem& system, ClothState& state) {
    for (std::size_t i = 0; i < state.velocity.size(); ++i)
      if (!system.pinned[i]) state.velocity.set(i, random.vector(1));
  });
  ASSERT_EQ(simulation.stepper().end_velocity, EndVelocity::solved);
  const double moving = simulation.measure().energy.kinetic;
  for (int n = 0; n < 20; ++n) {
    ASSERT_FALSE(simulation.step());
    EXPECT_LT(std::abs(simulation.measure().energy_error()), 1e-9 * moving) << n;
  }
  const double loss = simulation.measure().ledger.forces.damping_loss;
  EXPECT_GT(loss, 0.1 * moving);
  EXPECT_LT(loss, moving);
}

/// With the power of dampers at the velocities that contact leaves, for a whole step, 27 to 80 % of the energy
/// exchanged were booked too much.
TEST(StiffDampersAfterLongSteps, LoseWhatTheLedgerBooks) {
  for (const char* name : {"ball", "cube", "corner"})
    for (const char* method : {"implicit-euler", "bdf2", "projective", "vbd"}) {
      Scene scene = builtin_scene(name);
      scene.deformation.reset();
      scene.springs->damping = 0.34;
      scene.integrator = {.method = method, .time_step = 0.01};
      const ContactLedger ledger = ledger_run(scene, {}, 0.5);
      const std::string where = std::string(name) + ", " + method;
      EXPECT_LT(ledger.gain, 0.13 * ledger.account.exchanged()) << where;
      EXPECT_GT(ledger.account.exchanged(), 0.5) << where;
    }
}

/// A step of BDF2 after contact is one of implicit Euler. Solved with contact by two thirds of its weight, it
/// left springs stretched by 16 % where implicit Euler leaves 10.
TEST(Bdf2AfterContact, StretchesSpringsAsImplicitEulerDoes) {
  const auto strain_of = [](const char* method) {
    Scene scene = builtin_scene("rectangle");
    scene.deformation.reset();
    scene.integrator = {.method = method, .time_step = 0.01};
    return ledger_run(scene, {}, 1).largest_strain;
  };
  EXPECT_LT(strain_of("bdf2"), 1.1 * strain_of("implicit-euler"));
}

}  // namespace
}  // namespace cloth::test::contact_dampers_test
