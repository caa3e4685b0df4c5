// Laws of continuous contact: friction, bounce, rest, what it may not touch, and its part of the energy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contact/contact_report.h"
#include "integrators/registry.h"
#include "measure/energy.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "support/contact_scenes.h"
#include "support/random.h"

namespace cloth::test::contact_test {
namespace {

Vec3 mean_position(const Simulation& simulation) {
  Vec3 sum = Vec3::Zero();
  const Vec3Field& position = simulation.state().position;
  for (std::size_t i = 0; i < position.size(); ++i) sum += position[i];
  return sum / static_cast<double>(position.size());
}

void run(Simulation& simulation, double until) {
  while (simulation.time() + 0.5 * simulation.time_step() < until) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
  }
}

/// A sheet that lies a thickness above a plane of 15 degrees, falling towards -x.
Scene on_slope(double friction) {
  Scene scene = sheet_over(0);
  const double angle = 15 * std::numbers::pi / 180;
  const Vec3 normal(std::sin(angle), std::cos(angle), 0), along(std::cos(angle), -std::sin(angle), 0);
  scene.damping.reset();
  scene.cloth.across = along;
  scene.cloth.origin = -0.2 * along + 0.005 * normal;
  scene.obstacles.resize(1);
  scene.obstacles[0].shape = &plane_shape();
  scene.obstacles[0].normal = normal;
  scene.obstacles[0].friction = friction;
  scene.integrator = {.method = "verlet", .time_step = 0.002};
  return scene;
}

TEST(Friction, HoldsAClothBelowItsAngleWithoutCreeping) {
  Simulation simulation(on_slope(0.5));
  const Vec3 start = mean_position(simulation);
  run(simulation, 2);
  EXPECT_LE((mean_position(simulation) - start).norm(), 1e-9);
}

TEST(Friction, LetsAClothSlideAboveItsAngleAsCoulombSays) {
  constexpr double friction = 0.1, time = 1;
  const double angle = 15 * std::numbers::pi / 180;
  Simulation simulation(on_slope(friction));
  const Vec3 start = mean_position(simulation);
  run(simulation, time);
  const double slid = (mean_position(simulation) - start).norm();
  const double expected = 0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)) * time * time;
  EXPECT_NEAR(slid, expected, 0.01 * expected);
}

TEST(Contact, BringsAClothToRestOnABall) {
  Scene scene = contact_scene("sphere");
  scene.obstacles[0].friction = 0.6;
  scene.damping = 0.004;
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  Simulation simulation(scene, thrown({0, -1, 0}));
  double peak = 0;
  while (simulation.time() < 5) {
    ASSERT_FALSE(simulation.step());
    peak = std::max(peak, kinetic_energy(simulation.system(), simulation.state().velocity));
  }
  const ClothState before = simulation.state();
  EXPECT_LT(kinetic_energy(simulation.system(), before.velocity), 1e-6 * peak);
  run(simulation, 5.2);  // and stays there: no jitter
  double furthest = 0;
  for (std::size_t i = 0; i < before.position.size(); ++i)
    furthest = std::max(furthest, (simulation.state().position[i] - before.position[i]).norm());
  EXPECT_LT(furthest, 1e-4);
}

TEST(Contact, KeepsTheThicknessOnAPlane) {
  Scene scene = contact_scene("plane");
  scene.contact->thickness = 0.008;
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  Simulation simulation(scene, thrown({0, -1, 0}));
  run(simulation, 0.5);
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i) {
    EXPECT_GE(simulation.state().position[i].y(), 0.008 * (1 - 1e-3));
    EXPECT_LE(simulation.state().position[i].y(), 0.008 * 1.5);
  }
}

TEST(Contact, GivesBackWhatTheRestitutionSays) {
  Scene scene = contact_scene("plane");
  scene.gravity.reset();
  scene.damping.reset();
  scene.obstacles[0].restitution = 0.5;
  scene.obstacles[0].friction = 0;
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  Simulation simulation(scene, thrown({0.3, -2, 0}));
  const double before = kinetic_energy(simulation.system(), simulation.state().velocity);
  run(simulation, 0.1);
  for (std::size_t i = 0; i < simulation.state().velocity.size(); ++i)
    EXPECT_LE((simulation.state().velocity[i] - Vec3(0.3, 1, 0)).norm(), 1e-9);
  const double after = kinetic_energy(simulation.system(), simulation.state().velocity);
  EXPECT_NEAR(simulation.measure().ledger.contact, after - before, 1e-12);
}

TEST(Contact, IsAWorkInTheLedgerThatClosesTheEnergy) {
  for (const char* name : {"sphere", "corner", "itself", "turning-box"}) {
    Scene scene = contact_scene(name);
    scene.integrator = {.method = "verlet", .time_step = 2e-4};
    Simulation simulation(scene, thrown({0, -1, 0}));
    run(simulation, 0.2);
    const Measurement now = simulation.measure();
    EXPECT_NE(now.ledger.contact, 0) << name;
    EXPECT_LT(std::abs(now.energy_error()), 0.02 * std::abs(now.ledger.contact)) << name;
  }
}

TEST(Contact, NeverMovesAPin) {
  Scene scene = contact_scene("ball-from-below");
  scene.cloth.pins = {NamedPin::top_left, NamedPin::bottom_right, PinnedParticle{4, 4}};
  scene.obstacles[0].velocity = {0, 1, 0};
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  Simulation simulation(scene);
  while (simulation.time() < 0.4)
    if (simulation.step()) break;
  EXPECT_GT(simulation.time(), 0.2);
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    if (simulation.system().pinned[i]) {
      EXPECT_EQ(simulation.state().position[i], simulation.system().start[i]);
      EXPECT_EQ(simulation.state().velocity[i], Vec3(Vec3::Zero()));
    }
}

TEST(Contact, LeavesWhatItDoesNotTouchToTheBit) {
  Scene scene = contact_scene("plane");
  scene.obstacles[0].point.y() = -5;
  Scene alone = scene;
  alone.obstacles.clear(), alone.contact.reset();
  scene.integrator = alone.integrator = {.method = "rk4", .time_step = 0.001};
  Simulation with(scene), without(alone);
  run(with, 0.2);
  run(without, 0.2);
  EXPECT_EQ(with.state(), without.state());
}

TEST(APinch, IsReportedWithPlaceAndTime) {
  Scene scene = contact_scene("ball-from-below");
  scene.cloth.pins = {PinnedParticle{4, 4}};
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  Simulation simulation(scene);
  std::optional<Divergence> stop;
  while (!stop && simulation.time() < 0.2) stop = simulation.step();
  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->pinched) << describe(*stop);
  EXPECT_EQ(stop->particle, 40);
  // The ball's top starts at -0.24 m and rises at 5 m/s to the pin at 0.01 m.
  EXPECT_NEAR(stop->time, 0.05, 0.005);
  EXPECT_NE(describe(*stop).find("pinched"), std::string::npos) << describe(*stop);
}

/// The number of particles of the cloth that were behind the plane z = 0.
int behind(const Simulation& simulation) {
  int count = 0;
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    count += simulation.state().position[i].z() < 0;
  return count;
}

TEST(AParticleAtAKilometreASecond, StopsAtABoxAMillimetreThick) {
  Scene scene = sheet_over(0);
  scene.gravity.reset();
  scene.cloth.origin = {-0.2, 0.2, 0.5};
  scene.cloth.down = {0, -1, 0};
  scene.obstacles.resize(1);
  scene.obstacles[0].shape = &box_shape();
  scene.obstacles[0].center = {0, 0, 0};
  scene.obstacles[0].size = {2, 2, 0.001};
  for (const double step : {1e-4, 1e-2}) {
    scene.integrator = {.method = "implicit-euler", .time_step = step};
    Simulation simulation(scene, thrown({0, 0, -1000}));
    for (int n = 0; n < 20; ++n) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << describe(*stop);
    }
    EXPECT_EQ(behind(simulation), 0);
    EXPECT_EQ(all_crossings(simulation).number, 0);
  }
}

// Its way in a step is longer than what one search for pairs serves, and the first one does not see the mesh.
TEST(AFastCloth, StopsAtAMeshThatIsWiderThanItself) {
  Scene scene = contact_scene("cones");
  scene.cloth.width = scene.cloth.height = 0.2;
  scene.cloth.origin = {-0.095, 0.16, -0.102};
  scene.integrator = {.method = "implicit-euler", .time_step = 1e-3};
  Simulation simulation(scene, thrown({0, -400, 0}));
  const auto stop = simulation.step();
  ASSERT_FALSE(stop) << describe(*stop);
  EXPECT_EQ(all_crossings(simulation).number, 0);
  for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
    EXPECT_GT(simulation.state().position[i].y(), -0.1) << "particle " << i << " has passed";
}

TEST(ABallAtAHundredMetresASecond, DoesNotPassAHungCloth) {
  for (const double step : {1e-4, 1e-3, 1.0 / 60}) {
    Scene scene = sheet_over(0);
    scene.cloth.origin = {-0.2, 0.2, 0};
    scene.cloth.down = {0, -1, 0};
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    scene.obstacles.resize(1);
    scene.obstacles[0].center = {0.01, 0, -1};
    scene.obstacles[0].radius = 0.06;
    scene.obstacles[0].velocity = {0, 0, 100};
    scene.integrator = {.method = "implicit-euler", .time_step = step};
    Simulation simulation(scene);
    while (simulation.time() < 0.0125) {
      const auto stop = simulation.step();
      ASSERT_FALSE(stop) << describe(*stop);
      const Count count = all_crossings(simulation);
      ASSERT_EQ(count.number, 0) << "step " << step << ", t = " << simulation.time() << ": " << count.first;
    }
    // The particle ahead of the ball still is.
    EXPECT_GT(simulation.state().position[40].z(), 100 * simulation.time() - 1 + 0.05) << step;
  }
}

/// A whole turn in one step: where the blade ends it began, and no feature of it seems to have moved.
TEST(ABladeThatTurnsOnceInAStep, PushesTheClothAsideOrIsReportedAsStuck) {
  constexpr double step = 1.0 / 60;
  for (const double turns : {0.75, 1.0, -1.0, 1.5}) {
    Scene scene = sheet_over(0);
    scene.cloth.origin = {-0.2, 0.2, 0};
    scene.cloth.down = {0, -1, 0};
    scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
    scene.obstacles.resize(1);
    scene.obstacles[0].shape = &box_shape();
    scene.obstacles[0].center = {0.01, 0, 0.15};
    scene.obstacles[0].size = {0.36, 0.02, 0.02};
    scene.obstacles[0].spin = {0, 2 * std::numbers::pi * turns / step, 0};
    scene.integrator = {.method = "implicit-euler", .time_step = step};
    Simulation simulation(scene);
    if (simulation.step()) {
      EXPECT_TRUE(simulation.last_contact().pinch) << turns << " turns";
      continue;
    }
    double furthest = 0;
    for (std::size_t i = 0; i < simulation.state().position.size(); ++i)
      furthest = std::max(furthest, std::abs(simulation.state().position[i].z()));
    EXPECT_GT(furthest, 0.02) << turns << " turns: the blade reaches 0.03 m beyond the cloth";
  }
}

TEST(ContinuousContact, GivesTheSameBitsAgainAndFromACheckpoint) {
  for (const std::string& name : contact_scene_names())
    for (const char* method : {"verlet", "implicit-euler"}) {
      Scene scene = contact_scene(name);
      scene.integrator = {.method = method, .time_step = 0.002};
      Simulation first(scene, thrown({0, -2, 0})), second(scene, thrown({0, -2, 0}));
      run(first, 0.1);
      const Checkpoint checkpoint = first.checkpoint();
      run(first, 0.2);
      run(second, 0.2);
      EXPECT_EQ(first.state(), second.state()) << name << ", " << method;
      Simulation third(scene, thrown({0, -2, 0}));
      third.restore(checkpoint);
      run(third, 0.2);
      EXPECT_EQ(third.state(), first.state()) << name << ", " << method;
      EXPECT_EQ(third.measure().ledger.contact, first.measure().ledger.contact) << name;
    }
}

}  // namespace
}  // namespace cloth::test::contact_test
