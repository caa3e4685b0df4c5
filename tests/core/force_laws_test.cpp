// What every force keeps: it is minus the slope of its energy, its damping only takes, its power is its own.
#include <gtest/gtest.h>

#include "forces/gravity.h"
#include "forces/springs.h"
#include "forces/velocity_solver.h"
#include "geometry/dense_decompositions.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::force_laws_test {
namespace {

/// -dE/dx by central differences.
template <class EnergyOf>
Vec3Field downhill(const Vec3Field& at, double shift, EnergyOf energy_of) {
  Vec3Field slope(at.size()), position = at;
  const auto x = position.flat();
  const auto f = slope.flat();
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double here = x[k];
    x[k] = here + shift;
    const double above = energy_of(position);
    x[k] = here - shift;
    const double below = energy_of(position);
    x[k] = here;
    f[k] = (below - above) / (2 * shift);
  }
  return slope;
}

Vec3Field position_force(DirectRun& run) {
  Vec3Field force(run.state.position.size());
  run.forces.update(run.state.position, 0);
  run.forces.force(run.state.position, Vec3Field(force.size()), force);
  return force;
}

double elastic(const ClothSystem& system, const Vec3Field& position) {
  const auto parts = elastic_energy(system, position);
  return parts[0] + parts[1] + parts[2];
}

TEST(SpringForce, IsMinusTheSlopeOfItsEnergyInEveryFamily) {
  Random random;
  for (const SpringFamily family : spring_families) {
    Scene scene = bare_sheet(6, 5);
    scene.springs = only(family, 80);
    DirectRun run(scene, "verlet");
    run.state = crumpled_state(run.system, 0.04, 0, random);
    const Vec3Field expected =
        downhill(run.state.position, 1e-6, [&](const Vec3Field& x) { return elastic(run.system, x); });
    const Vec3Field force = position_force(run);
    EXPECT_LE(largest_distance(force, expected), 1e-7 * largest_norm(force)) << name_of(family);
    EXPECT_GT(largest_norm(force), 1) << name_of(family);
  }
}

TEST(SpringForce, EqualsTheSumOverThePairsOfTheTable) {
  Random random;
  Scene scene = bare_sheet(9, 131);  // longer than a kernel's chunk
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0};
  DirectRun run(scene, "verlet");
  run.state = crumpled_state(run.system, 0.04, 0, random);
  const Vec3Field expected = spring_forces(springs_by_the_table(scene), run.state.position);
  EXPECT_LE(largest_distance(position_force(run), expected), 1e-12 * largest_norm(expected));
  const double energy = spring_energy(springs_by_the_table(scene), run.state.position);
  EXPECT_NEAR(elastic(run.system, run.state.position), energy, 1e-12 * energy);
}

TEST(GravityForce, IsMinusTheSlopeOfItsEnergy) {
  Random random;
  Scene scene = bare_sheet(4, 4);
  scene.gravity = Vec3(1, -9.81, 2);
  DirectRun run(scene, "verlet");
  run.state = crumpled_state(run.system, 0.5, 0, random);
  const Vec3Field expected = downhill(run.state.position, 1e-3, [&](const Vec3Field& x) {
    return gravity_energy(run.system, *scene.gravity, x);
  });
  EXPECT_LE(largest_distance(position_force(run), expected), 1e-10);
  EXPECT_EQ(gravity_energy(run.system, *scene.gravity, run.system.start), 0);
}

/// Scenes with every combination of the forces that depend on the velocity.
std::vector<Scene> damped_scenes() {
  std::vector<Scene> scenes;
  for (int which = 1; which < 8; ++which) {
    Scene scene = bare_sheet(5, 4);
    scene.cloth.pins = {NamedPin::top_left, PinnedParticle{2, 1}};
    scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0};
    if (which & 1) scene.damping = 0.3;
    if (which & 2) scene.air = Air{.drag = 0.7, .wind = {1, 2, 3}, .gust = std::nullopt};
    if (which & 4) scene.springs->damping = 0.5;
    scenes.push_back(scene);
  }
  return scenes;
}

TEST(Damping, IsSymmetricAndTakesOnly) {
  Random random;
  for (const Scene& scene : damped_scenes()) {
    DirectRun run(scene, "verlet");
    run.state = crumpled_state(run.system, 0.05, 1, random);
    run.forces.update(run.state.position, 0.3);
    ASSERT_TRUE(run.forces.has_damping());
    const Eigen::MatrixXd matrix = damping_matrix(run.forces, run.state.position);
    const double scale = matrix.cwiseAbs().maxCoeff();
    EXPECT_LE((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 1e-12 * scale);
    EXPECT_GE(symmetric_values(matrix).minCoeff(), -1e-12 * scale);
  }
}

TEST(Damping, IsWhatTheForceLosesByTheVelocity) {
  Random random;
  for (const Scene& scene : damped_scenes()) {
    DirectRun run(scene, "verlet");
    run.state = crumpled_state(run.system, 0.05, 1, random);
    run.forces.update(run.state.position, 0.3);
    const Eigen::MatrixXd matrix = damping_matrix(run.forces, run.state.position);
    Vec3Field still(run.state.position.size()), moving(run.state.position.size());
    run.forces.force(run.state.position, Vec3Field(still.size()), still);
    run.forces.force(run.state.position, run.state.velocity, moving);
    const Eigen::VectorXd lost = interleaved(still) - interleaved(moving);
    EXPECT_LE((lost - matrix * interleaved(run.state.velocity)).norm(), 1e-12 * lost.norm());
  }
}

TEST(Power, IsForceTimesVelocityWithoutTheConservativePart) {
  Random random;
  for (Scene scene : damped_scenes()) {
    scene.gravity = Vec3(0, -9.81, 0);
    DirectRun run(scene, "verlet");
    run.state = crumpled_state(run.system, 0.05, 1, random);
    run.forces.update(run.state.position, 0);
    Vec3Field all(run.state.position.size());
    run.forces.force(run.state.position, run.state.velocity, all);
    Scene conservative = scene;
    conservative.damping.reset(), conservative.air.reset(), conservative.springs->damping = 0;
    DirectRun rest(conservative, "verlet");
    rest.state = run.state;
    const double expected =
        interleaved(run.state.velocity).dot(interleaved(all) - interleaved(position_force(rest)));
    const Work power = run.forces.power(run.state.position, run.state.velocity);
    EXPECT_NEAR(power.air + power.brush + power.pull - power.damping_loss, expected,
                1e-12 * (1 + std::abs(expected)));
    EXPECT_GE(power.damping_loss, 0);
  }
}

TEST(Power, OfTheDampingIsMinusVDv) {
  Random random;
  for (Scene scene : damped_scenes()) {
    scene.air.reset();  // still, so that all power is loss
    if (!scene.damping && !(scene.springs->damping > 0)) continue;
    DirectRun run(scene, "verlet");
    run.state = crumpled_state(run.system, 0.05, 1, random);
    run.forces.update(run.state.position, 0);
    const Eigen::VectorXd v = interleaved(run.state.velocity);
    const double expected = v.dot(damping_matrix(run.forces, run.state.position) * v);
    EXPECT_NEAR(run.forces.power(run.state.position, run.state.velocity).damping_loss, expected,
                1e-12 * expected);
  }
}

/// The largest residual of (m + weight D) v = m known + weight p over the free particles.
double residual_of(DirectRun& run, double weight, const Vec3Field& known, const Vec3Field& velocity) {
  Vec3Field force(known.size());
  run.forces.force(run.state.position, velocity, force);  // p - D v
  double largest = 0;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!run.system.pinned[i])
      largest =
          std::max(largest, (run.system.mass.front() * (velocity[i] - known[i]) - weight * force[i]).norm());
  return largest;
}

void crumple(DirectRun& run, bool pulled, Random& random) {
  run.state = crumpled_state(run.system, 0.05, 1, random);
  if (pulled) run.forces.set_pull(Pull{9, {1, 1, 1}}, 30, 0.8);
  run.forces.update(run.state.position, 0.3);
}

TEST(CentredVelocity, SolvesItsEquationForEveryCombinationWithPins) {
  Random random;
  for (const bool pulled : {false, true}) {
    for (const Scene& scene : damped_scenes()) {
      DirectRun run(scene, "verlet");
      crumple(run, pulled, random);
      Vec3Field velocity = run.state.velocity, guess(velocity.size());
      const double weight = 0.02;
      const int iterations =
          VelocitySolver().solve(run.forces, weight, solved_tolerance, run.state.position, velocity, guess);
      const double scale = run.system.mass.front() * largest_norm(run.state.velocity);
      EXPECT_LE(residual_of(run, weight, run.state.velocity, velocity), 1e-11 * scale);
      EXPECT_EQ(iterations > 0, scene.springs->damping > 0);
      for (std::size_t i = 0; i < velocity.size(); ++i)
        if (run.system.pinned[i]) {
          EXPECT_EQ(velocity[i].norm(), 0);
        }
    }
  }
}

/// More than one strip of the solve (forces/node_matrix.h), the last one not whole, and dampers so stiff for
/// the light particles that w p is most of the right-hand side.
TEST(CentredVelocity, SolvesItsEquationOverManyStripsAndWithStiffDampers) {
  Random random;
  for (const bool pulled : {false, true}) {
    for (Scene scene : damped_scenes()) {
      scene.cloth.rows = 23, scene.cloth.columns = 27;
      DirectRun run(scene, "verlet");
      crumple(run, pulled, random);
      Vec3Field velocity = run.state.velocity, guess(velocity.size());
      const double weight = 0.02;
      VelocitySolver().solve(run.forces, weight, solved_tolerance, run.state.position, velocity, guess);
      const double right_hand_side = run.system.mass.front() * largest_norm(run.state.velocity) +
                                     weight * largest_norm(run.forces.position_force());
      EXPECT_LE(residual_of(run, weight, run.state.velocity, velocity), 1e-11 * right_hand_side);
    }
  }
}

}  // namespace
}  // namespace cloth::test::force_laws_test
