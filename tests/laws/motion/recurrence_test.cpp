// The schemes' own recurrences, on a crumpled nonlinear cloth, to rounding. Accelerations come from the
// reference computation in support/, spring by spring.
#include <gtest/gtest.h>

#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::recurrence_test {
namespace {

constexpr double step = 1e-3;
const Vec3 gravity(0.3, -9.81, 0.2);

Scene undamped() {
  Scene scene = bare_sheet(6, 5);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 20, .damping = 0};
  scene.gravity = gravity;
  return scene;
}

/// The acceleration of particle i at these positions.
class Accelerations {
 public:
  explicit Accelerations(const Scene& scene) : springs_(springs_by_the_table(scene)) {}
  Vec3Field at(const ClothSystem& system, const Vec3Field& position) const {
    Vec3Field acceleration = spring_forces(springs_, position);
    for (std::size_t i = 0; i < position.size(); ++i)
      acceleration.set(
          i, system.pinned[i] ? Vec3(0, 0, 0) : Vec3(acceleration[i] / system.mass.front() + gravity));
    return acceleration;
  }

 private:
  std::vector<SpringPair> springs_;
};

void expect_stoermers_recurrence(const std::string& method) {
  Random random;
  const Scene scene = undamped();
  const Accelerations accelerations(scene);
  DirectRun run(scene, method);
  run.state = crumpled_state(run.system, 0.03, 0.5, random);
  Vec3Field before = run.state.position;
  run.advance(1, step);
  for (int n = 0; n < 500; ++n) {
    const Vec3Field now = run.state.position;
    const Vec3Field a = accelerations.at(run.system, now);
    run.advance(1, step);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 residual = run.state.position[i] - 2 * now[i] + before[i] - step * step * a[i];
      ASSERT_LE(residual.norm(), 2e-15) << method << " step " << n << " particle " << i;
    }
    before = now;
  }
}

TEST(Verlet, FollowsStoermersThreeTermRecurrence) {  // report, Eq. (14)
  expect_stoermers_recurrence("verlet");
}

TEST(SemiImplicitEuler, FollowsStoermersThreeTermRecurrence) {
  expect_stoermers_recurrence("semi-implicit-euler");
}

TEST(Verlet, HasTheCentredDifferenceAsItsVelocity) {
  Random random;
  DirectRun run(undamped(), "verlet");
  run.state = crumpled_state(run.system, 0.03, 0.5, random);
  Vec3Field before = run.state.position;
  run.advance(1, step);
  for (int n = 0; n < 100; ++n) {
    const ClothState now = run.state;
    run.advance(1, step);
    for (std::size_t i = 0; i < before.size(); ++i)
      ASSERT_LE((now.velocity[i] - (run.state.position[i] - before[i]) / (2 * step)).norm(), 1e-12);
    before = now.position;
  }
}

TEST(SemiImplicitEuler, KicksThenDrifts) {  // report, Eqs. (6) and (7)
  Random random;
  const Accelerations accelerations(undamped());
  DirectRun run(undamped(), "semi-implicit-euler");
  run.state = crumpled_state(run.system, 0.03, 0.5, random);
  for (int n = 0; n < 100; ++n) {
    const ClothState now = run.state;
    const Vec3Field a = accelerations.at(run.system, now.position);
    run.advance(1, step);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_LE((run.state.velocity[i] - now.velocity[i] - step * a[i]).norm(), 1e-13);
      ASSERT_LE((run.state.position[i] - now.position[i] - step * run.state.velocity[i]).norm(), 1e-15);
    }
  }
}

TEST(ExplicitEuler, DriftsWithTheOldVelocity) {
  Random random;
  const Accelerations accelerations(undamped());
  DirectRun run(undamped(), "explicit-euler");
  run.state = crumpled_state(run.system, 0.03, 0.5, random);
  for (int n = 0; n < 20; ++n) {
    const ClothState now = run.state;
    const Vec3Field a = accelerations.at(run.system, now.position);
    run.advance(1, step);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_LE((run.state.velocity[i] - now.velocity[i] - step * a[i]).norm(), 1e-12);
      ASSERT_LE((run.state.position[i] - now.position[i] - step * now.velocity[i]).norm(), 1e-15);
    }
  }
}

TEST(SemiImplicitEuler, StartedHalfAKickEarlierIsVerlet) {
  Random random;
  const Scene scene = undamped();
  DirectRun verlet(scene, "verlet"), euler(scene, "semi-implicit-euler");
  verlet.state = crumpled_state(verlet.system, 0.03, 0.5, random);
  euler.state = verlet.state;
  add_scaled(-0.5 * step, euler.acceleration(), euler.state.velocity);
  verlet.advance(200, step);
  euler.advance(200, step);
  EXPECT_LE(largest_distance(verlet.state.position, euler.state.position), 1e-12);
}

}  // namespace
}  // namespace cloth::test::recurrence_test
