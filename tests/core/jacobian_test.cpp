// The linearised forces against finite differences: A = M + b D + a K and the asymmetric rest together are
// the exact Jacobian M - b df/dv - a df/dx of every force that a scene can have.
#include <gtest/gtest.h>

#include <cmath>

#include "integrators/implicit/linear_solver.h"
#include "kernels/instruction_set.h"
#include "support/direct_run.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::jacobian_test {
namespace {

constexpr double of_positions = 0.3, of_velocities = 0.7;  // weights of -df/dx and -df/dv

Vec3Field force_at(DirectRun& run, const Vec3Field& position, const Vec3Field& velocity) {
  Vec3Field force(position.size());
  run.forces.update(position, run.state.time);
  run.forces.force(position, velocity, force);
  return force;
}

Vec3Field moved(const Vec3Field& from, double by, const Vec3Field& along) {
  Vec3Field to = from;
  add_scaled(by, along, to);
  return to;
}

/// M u - of_velocities df/dv u - of_positions df/dx u by central differences; zero on pins.
Vec3Field difference_product(DirectRun& run, const Vec3Field& u) {
  constexpr double shift = 1e-6;
  const ClothState& s = run.state;
  const Vec3Field ahead =
      force_at(run, moved(s.position, of_positions * shift, u), moved(s.velocity, of_velocities * shift, u));
  const Vec3Field behind = force_at(run, moved(s.position, -of_positions * shift, u),
                                    moved(s.velocity, -of_velocities * shift, u));
  Vec3Field product(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!run.system.pinned[i])
      product.set(i, run.system.mass[i] * u[i] - (ahead[i] - behind[i]) / (2 * shift));
  return product;
}

Vec3Field exact_product(DirectRun& run, const Vec3Field& u) {
  Linearisation linearisation;
  Vec3Field product(u.size()), rest(u.size());
  force_at(run, run.state.position, run.state.velocity);
  run.forces.linearise(run.state.position,
                       {.position = of_positions, .velocity = of_velocities, .clamped = false},
                       linearisation);
  linearisation.multiply(run.system, u, product);
  run.forces.asymmetric_product(run.state.position, run.state.velocity, u, rest);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!run.system.pinned[i]) product.add(i, of_positions * rest[i]);
  return product;
}

void expect_exact(const Scene& scene, const std::string& what, const std::optional<BrushGust>& brush = {},
                  const std::optional<Pull>& pull = {}) {
  Random random;
  DirectRun run(scene, "verlet");
  run.forces.set_brush(brush);
  run.forces.set_pull(pull, 30, 0.2);
  run.state = crumpled_state(run.system, 0.03, 0.8, random);
  run.state.time = 0.37;
  for (int n = 0; n < 5; ++n) {
    Vec3Field u = random.field(run.state.position.size(), 1);
    for (std::size_t i = 0; i < u.size(); ++i)
      if (run.system.pinned[i]) u.set(i, Vec3::Zero());
    const Vec3Field exact = exact_product(run, u), expected = difference_product(run, u);
    EXPECT_LE(largest_distance(exact, expected), 2e-7 * largest_norm(expected)) << what;
  }
}

Scene pinned_sheet() {
  Scene scene = bare_sheet(6, 5);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  return scene;
}

TEST(Jacobian, OfEverySpringFamilyIsItsForcesSlope) {
  for (const SpringFamily family : spring_families) {
    Scene scene = pinned_sheet();
    scene.springs = only(family, 80);
    expect_exact(scene, name_of(family));
  }
}

TEST(Jacobian, OfSpringDampingIsItsForcesSlopeInPositionsAndVelocities) {
  Scene scene = pinned_sheet();
  scene.springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 10, .damping = 0.6};
  expect_exact(scene, "spring damping");
}

TEST(Jacobian, OfViscousDampingAndAPullIsTheirForcesSlope) {
  Scene scene = pinned_sheet();
  scene.damping = 0.3;
  expect_exact(scene, "viscous damping and pull", {}, Pull{.particle = 17, .target = {0.3, -0.2, 0.4}});
}

TEST(Jacobian, OfAirWithWindAndBrushIsItsForcesSlope) {
  Scene scene = pinned_sheet();
  scene.air = Air{.drag = 0.4, .wind = {1, -0.5, 3}, .gust = Gust{}};
  expect_exact(scene, "air");
  BrushGust brush{.velocity = {2, 1, -4}};
  brush.world_to_screen.row(0) << 200, 10, 5, 20;
  brush.world_to_screen.row(1) << -8, 150, 30, 40;
  brush.world_to_screen.row(3) << 0.1, 0.05, 0.2, 1;
  brush.cursor = {60, 10};
  brush.radius = 90;
  expect_exact(scene, "brush", brush);
}

TEST(Jacobian, OfAirAlongHeldNormalsIsItsForcesSlope) {
  Random random;
  Scene scene = pinned_sheet();
  scene.air = Air{.drag = 0.4, .skin_friction = 0.1, .wind = {1, -0.5, 3}, .gust = {}};
  DirectRun run(scene, "verlet");
  run.state = crumpled_state(run.system, 0.03, 0.8, random);
  run.forces.update(run.state.position, 0);
  run.forces.hold_normals(true);
  run.state.position = moved(run.state.position, 0.02, random.field(run.state.position.size(), 1));
  Vec3Field u = random.field(run.state.position.size(), 1);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (run.system.pinned[i]) u.set(i, Vec3::Zero());
  const Vec3Field held = exact_product(run, u), expected = difference_product(run, u);
  EXPECT_LE(largest_distance(held, expected), 2e-7 * largest_norm(expected));
  run.forces.hold_normals(false);
  EXPECT_GT(largest_distance(exact_product(run, u), held), 1e-3 * largest_norm(held));
}

TEST(Jacobian, WithClampedCompressionIsPositiveDefiniteWhereTheExactOneIsNot) {
  Random random;
  Scene scene = pinned_sheet();
  scene.springs = SpringMaterial{.structural = 1e5, .shear = 5e4, .flexion = 1e4};
  DirectRun run(scene, "verlet");
  for (std::size_t i = 0; i < run.state.position.size(); ++i)
    run.state.position.set(i, 0.8 * run.state.position[i]);
  run.forces.update(run.state.position, 0);
  Linearisation linearisation;
  CholeskyFactors factors;
  run.forces.linearise(run.state.position, {.position = 1, .velocity = 1, .clamped = false}, linearisation);
  EXPECT_TRUE(linearisation.has_compressed);
  EXPECT_FALSE(factors.factorise(run.system, linearisation));
  run.forces.linearise(run.state.position, {.position = 1, .velocity = 1, .clamped = true}, linearisation);
  EXPECT_TRUE(factors.factorise(run.system, linearisation));
}

// A run of a row is longer than what a kernel takes at once.
TEST(Jacobian, OfSpringsHasTheSameBitsOnEveryInstructionSetAndAStiffnessWhereASpringHasNoDirection) {
  Scene scene = bare_sheet(3, 150);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20};
  DirectRun run(scene, "verlet");
  Random random;
  Vec3Field position = moved(run.state.position, 0.002, random.field(run.state.position.size(), 1));
  position.set(1, position[0]);
  for (const bool clamped : {false, true}) {
    std::vector<Linearisation> of_sets;
    for (const InstructionSet set : supported_instruction_sets()) {
      set_instruction_set(set);
      run.forces.linearise(position, {.position = 0.5, .velocity = 1, .clamped = clamped},
                           of_sets.emplace_back());
      EXPECT_EQ(of_sets.back().springs.runs(), of_sets.front().springs.runs()) << name_of(set);
    }
    set_instruction_set(std::nullopt);
    EXPECT_EQ(of_sets.front().springs[0].matrix(), 0.5 * 80 * Eigen::Matrix3d::Identity());
  }
}

TEST(Jacobian, OfDampersHasTheSameBitsOnEveryInstructionSetAndNoneWhereASpringHasNoDirection) {
  Scene scene = bare_sheet(3, 150);
  scene.springs = SpringMaterial{.structural = 1e-9, .damping = 0.6};
  DirectRun run(scene, "verlet");
  Random random;
  const std::size_t size = run.state.position.size();
  Vec3Field position = moved(run.state.position, 0.002, random.field(size, 1));
  position.set(1, position[0]);
  const Vec3Field velocity = random.field(size, 1), u = random.field(size, 1);
  std::vector<Linearisation> of_sets;
  std::vector<Vec3Field> products;
  for (const InstructionSet set : supported_instruction_sets()) {
    set_instruction_set(set);
    run.forces.update(position, 0);
    run.forces.linearise(position, {.position = 0, .velocity = 1, .clamped = false}, of_sets.emplace_back());
    run.forces.asymmetric_product(position, velocity, u, products.emplace_back(size));
    EXPECT_EQ(of_sets.back().springs.runs(), of_sets.front().springs.runs()) << name_of(set);
    EXPECT_TRUE(products.back() == products.front()) << name_of(set);
  }
  set_instruction_set(std::nullopt);
  EXPECT_EQ(of_sets.front().springs[0].matrix(), Eigen::Matrix3d::Zero());
  EXPECT_NEAR(of_sets.front().springs[5].matrix().trace(), 0.6, 1e-15);
  EXPECT_GT(largest_norm(products.front()), 0.1);
}

TEST(LinearSolvers, AllFindTheSameSolution) {
  Random random;
  Scene scene = pinned_sheet();
  scene.springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 10, .damping = 0.1};
  DirectRun run(scene, "verlet");
  run.state = crumpled_state(run.system, 0.003, 0, random);
  run.forces.update(run.state.position, 0);
  Linearisation linearisation;
  run.forces.linearise(run.state.position, {.position = 1e-4, .velocity = 1e-2, .clamped = true},
                       linearisation);
  Vec3Field b = random.field(run.state.position.size(), 1);
  for (std::size_t i = 0; i < b.size(); ++i)
    if (run.system.pinned[i]) b.set(i, Vec3::Zero());

  CholeskyFactors factors;
  BlockJacobi jacobi;
  ASSERT_TRUE(factors.factorise(run.system, linearisation));
  jacobi.prepare(run.system, linearisation);
  const LinearMap matrix = [&](const Vec3Field& in, Vec3Field& out) {
    linearisation.multiply(run.system, in, out);
  };
  const LinearMap preconditioner = [&](const Vec3Field& in, Vec3Field& out) { jacobi.solve(in, out); };
  Vec3Field by_factors(b.size()), by_gradients(b.size()), by_residuals(b.size()), back(b.size());
  factors.solve(b, by_factors);
  matrix(by_factors, back);
  EXPECT_LE(largest_distance(back, b), 1e-10 * largest_norm(b));
  ConjugateGradients gradients;
  EXPECT_TRUE(gradients.solve(run.system, linearisation, jacobi, b, 1e-12, by_gradients).converged);
  MinimalResiduals residuals;
  residuals.solve(matrix, preconditioner, b, 1e-12, by_residuals);
  EXPECT_LE(largest_distance(by_factors, by_gradients), 1e-9 * largest_norm(by_factors));
  EXPECT_LE(largest_distance(by_factors, by_residuals), 1e-9 * largest_norm(by_factors));
}

}  // namespace
}  // namespace cloth::test::jacobian_test
