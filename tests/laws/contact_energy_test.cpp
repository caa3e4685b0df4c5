// The ledger of contact: its work is that of its impulses. Obstacles at rest give nothing, and restitution
// does not keep a cloth from coming to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/registry.h"
#include "measure/energy.h"
#include "simulation/time_step.h"
#include "support/contact_check.h"

namespace cloth::test::contact_energy_test {
namespace {

/// J; of the steps of a run.
struct ContactLedger {
  double exchanged = 0;     ///< the largest of all energies and works
  double work = 0;          ///< of contact
  double positive = 0;      ///< what the steps that gave something gave
  double largest_gift = 0;  ///< of a step
  double error = 0;         ///< of the energy, the largest
};

ContactLedger ledger_of(const Scene& scene, const Preparation& prepare, double time) {
  Simulation simulation(scene, prepare);
  ContactLedger ledger;
  while (simulation.time() + 0.5 * simulation.time_step() < time) {
    const auto stop = simulation.step();
    EXPECT_FALSE(stop) << describe(*stop);
    if (stop) break;
    const Measurement now = simulation.measure();
    const double given = now.ledger.contact - ledger.work;
    ledger.work = now.ledger.contact;
    ledger.positive += std::max(given, 0.0);
    ledger.largest_gift = std::max(ledger.largest_gift, given);
    ledger.error = std::max(ledger.error, std::abs(now.energy_error()));
    for (const double energy : {now.energy.kinetic, now.energy.elastic, now.energy.gravity,
                                now.ledger.contact, now.ledger.forces.damping_loss, now.ledger.forces.air})
      ledger.exchanged = std::max(ledger.exchanged, std::abs(energy));
  }
  return ledger;
}

class ContactOf : public ::testing::TestWithParam<std::string> {};

TEST_P(ContactOf, ObstaclesAtRestGivesNothing) {
  for (const char* name : {"sphere", "box", "corner", "cones"})
    for (const double restitution : {0.0, 1.0})
      for (const bool continuous : {true, false}) {
        Scene scene = contact_scene(name);
        if (!continuous && scene.obstacles[0].shape == Shape::mesh) continue;
        if (!continuous) scene.contact.reset(), scene.obstacles[0].keyframes.clear();
        scene.obstacles[0].friction = 0.5;
        scene.obstacles[0].restitution = restitution;
        scene.integrator = {.method = GetParam(), .time_step = GetParam() == "explicit-euler" ? 1e-4 : 1e-3};
        const ContactLedger ledger =
            ledger_of(scene, thrown({0, -1, 0}), GetParam() == "explicit-euler" ? 0.05 : 0.3);
        const std::string where = std::string(name) + (continuous ? "" : ", particle by particle") +
                                  ", restitution " + std::to_string(restitution);
        EXPECT_LE(ledger.work, 0) << where;
        EXPECT_LT(ledger.largest_gift, 1e-3 * ledger.exchanged) << where;
        EXPECT_LT(ledger.positive, 5e-3 * ledger.exchanged) << where;
      }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, ContactOf, ::testing::ValuesIn(integrator_names()),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace cloth::test::contact_energy_test
