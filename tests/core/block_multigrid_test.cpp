// Multigrid for the Jacobian of an implicit step on a grid, against dense algebra and Cholesky factors.
#include "sparse/block_multigrid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/dense_decompositions.h"
#include "integrators/implicit/linear_choice.h"
#include "integrators/implicit/multigrid_solver.h"
#include "kernels/instruction_set.h"
#include "support/direct_run.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::block_multigrid_test {
namespace {

class JacobianOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, JacobianOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

/// A crumpled cloth with the clamped Jacobian of a long step, and what solves with it.
struct Crumpled {
  Crumpled(Scene scene, double h, double deviation) : run(scene, "implicit-euler"), step(h) {
    Random random;
    run.state = crumpled_state(run.system, deviation, 0.5, random);
    run.forces.update(run.state.position, 0);
    linearise(true, clamped), linearise(false, exact);
  }
  void linearise(bool clamps, Linearisation& to) {
    run.forces.linearise(run.state.position, {.position = step * step, .velocity = step, .clamped = clamps},
                         to);
  }
  std::size_t size() const { return run.state.position.size(); }
  /// A right-hand side, zero on pins.
  Vec3Field residual() const {
    Random random;
    Vec3Field field = random.field(size(), 1e-3);
    for (std::size_t i = 0; i < size(); ++i)
      if (run.system.pinned[i]) field.set(i, Vec3::Zero());
    return field;
  }

  DirectRun run;
  double step;
  Linearisation clamped, exact;
};

Scene sheet(int rows, int columns) {
  Scene scene = smooth_scene(rows, columns);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 20, .damping = 0.02};
  return scene;
}

Scene sheet_of(const Material& material, int rows, int columns) {
  Scene scene = smooth_scene(rows, columns);
  scene.springs.reset(), scene.damping.reset(), scene.air.reset();
  scene.material = material;
  return scene;
}

/// Of cells of 1 mm, whose bending is stiffer than their springs.
Scene paper(int rows, int columns) {
  Material material;
  material.areal_density = 0.1, material.shear = 100;
  material.stretch_warp = material.stretch_weft = 300;
  material.bending_warp = material.bending_weft = material.twist = 4e-4;
  material.bending_damping = 0.001;
  Scene scene = sheet_of(material, rows, columns);
  scene.cloth.width = 0.001 * (columns - 1), scene.cloth.height = 0.001 * (rows - 1);
  return scene;
}

/// The matrix of a linear map, column by column; one on the diagonal of pins.
template <class Map>
Eigen::MatrixXd matrix_of(const Crumpled& cloth, Map map) {
  const auto numbers = static_cast<Eigen::Index>(3 * cloth.size());
  Eigen::MatrixXd matrix(numbers, numbers);
  Vec3Field unit(cloth.size()), image(cloth.size());
  for (Eigen::Index k = 0; k < numbers; ++k) {
    const auto number = static_cast<std::size_t>(k);
    const bool pinned = cloth.run.system.pinned[number % cloth.size()];
    unit.fill(0);
    if (!pinned) unit.flat()[number] = 1;
    map(unit, image);
    for (Eigen::Index i = 0; i < numbers; ++i) matrix(i, k) = image.flat()[static_cast<std::size_t>(i)];
    if (pinned) matrix(k, k) = 1;
  }
  return matrix;
}

/// Of M + h D + h^2 K, A, and a cycle, B: B is symmetric, and I - B A is no more than `most` in A's norm.
void expect_a_cycle_that_reduces_every_error(const Scene& scene, double h, double deviation, double most) {
  Crumpled cloth(scene, h, deviation);
  SCOPED_TRACE(::testing::Message() << scene.cloth.rows << " x " << scene.cloth.columns);
  MultigridSolver solver;
  ASSERT_TRUE(MultigridSolver::suits(cloth.run.system));
  ASSERT_TRUE(solver.prepare(cloth.run.system, cloth.clamped));
  const Eigen::MatrixXd a = matrix_of(
      cloth, [&](const Vec3Field& in, Vec3Field& out) { cloth.clamped.multiply(cloth.run.system, in, out); });
  const Eigen::MatrixXd b =
      matrix_of(cloth, [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); });
  EXPECT_LE((b - b.transpose()).norm(), 1e-4 * b.norm());
  const Eigen::MatrixXd root = cholesky_factor(a).value();
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(a.rows(), a.cols()) - Eigen::MatrixXd(root.transpose() * b * root);
  EXPECT_LT(spectral_norm(left), most);
}

TEST_P(JacobianOfEverySet, HasACycleThatIsSymmetricAndReducesEveryErrorInItsNorm) {
  for (const auto& [rows, columns] : {std::pair(9, 9), {8, 11}, {12, 7}, {6, 14}, {3, 17}})
    expect_a_cycle_that_reduces_every_error(sheet(rows, columns), 0.02, 0.01, 0.9);
}

TEST_P(JacobianOfEverySet, HasSuchACycleWhereBendingIsStifferThanSprings) {
  for (const auto& [rows, columns] : {std::pair(9, 9), {8, 11}, {12, 7}, {6, 14}, {3, 17}}) {
    const Scene scene = paper(rows, columns);
    ASSERT_EQ(MultigridSolver::interpolation(DirectRun(scene, "implicit-euler").system),
              Interpolation::cubic_splines);
    expect_a_cycle_that_reduces_every_error(scene, 0.001, 1e-5, 0.9);
  }
}

void expect_the_solution_of_factors(const Scene& scene, double h, int most_iterations) {
  Crumpled cloth(scene, h, 0.003);
  MultigridSolver solver;
  ASSERT_TRUE(solver.prepare(cloth.run.system, cloth.clamped));
  CholeskyFactors factors;
  ASSERT_TRUE(factors.factorise(cloth.run.system, cloth.clamped));
  const Vec3Field residual = cloth.residual();
  Vec3Field expected(cloth.size()), solution(cloth.size());
  factors.solve(residual, expected);
  ConjugateGradients gradients;
  const KrylovReport report = gradients.solve(
      cloth.run.system, cloth.clamped,
      [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); }, residual, 1e-10, solution);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, most_iterations);
  EXPECT_LE(largest_distance(solution, expected), 1e-8 * largest_norm(expected));
}

TEST_P(JacobianOfEverySet, IsSolvedAsByFactorsInFewIterations) {
  for (const auto& [rows, columns] : {std::pair(33, 33), {40, 29}, {26, 64}})
    expect_the_solution_of_factors(sheet(rows, columns), 0.02, 60);
}

TEST_P(JacobianOfEverySet, IsSolvedAsByFactorsWithAMaterialThatBends) {
  Material material;
  material.areal_density = 0.15, material.shear = 40;
  material.stretch_warp = 300, material.stretch_weft = 200;
  material.bending_warp = 2e-4, material.bending_weft = 1e-4, material.twist = 1e-4;
  material.bending_damping = 0.001;
  expect_the_solution_of_factors(sheet_of(material, 30, 31), 0.02, 80);
}

int iterations_to_a_thousandth(const Scene& scene, double h, double deviation) {
  Crumpled cloth(scene, h, deviation);
  MultigridSolver solver;
  if (!solver.prepare(cloth.run.system, cloth.clamped)) return -1;
  Vec3Field solution(cloth.size());
  ConjugateGradients gradients;
  const LinearMap cycle = [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); };
  return gradients.solve(cloth.run.system, cloth.clamped, cycle, cloth.residual(), 1e-3, solution).iterations;
}

/// By linear interpolation they are 8, 11 and 36.
TEST(BlockMultigrid, NeedsNoMoreIterationsForAFinerStripOfPaper) {
  std::vector<int> iterations;
  for (const int rows : {33, 65, 129}) {
    Scene scene = paper(rows, (rows - 1) / 5 + 1);
    scene.cloth.width = 0.04, scene.cloth.height = 0.2;
    scene.material->stretch_warp = scene.material->stretch_weft = 10, scene.material->shear = 4;
    iterations.push_back(iterations_to_a_thousandth(scene, 0.02, 1e-4 / rows));
  }
  EXPECT_GT(iterations[0], 1);
  EXPECT_LE(iterations[1], iterations[0] + 1);
  EXPECT_LE(iterations[2], iterations[0] + 1);
}

TEST(BlockMultigrid, NeedsHardlyMoreIterationsOnFinerGrids) {
  std::vector<int> iterations;
  for (const int side : {17, 33, 65}) {
    Scene scene = sheet(side, side);
    scene.cloth.width = scene.cloth.height = 1;
    iterations.push_back(iterations_to_a_thousandth(scene, 0.02, 0.02 / side));
  }
  EXPECT_GT(iterations[0], 2);
  EXPECT_LE(iterations[1], iterations[0] + 6);
  EXPECT_LE(iterations[2], iterations[1] + 6);
}

TEST(BlockMultigrid, MeetsNegativeCurvatureOfTheExactMatrixAsOtherGradientsDo) {
  Scene scene = sheet(20, 20);
  scene.cloth.width *= 0.9;
  Crumpled cloth(scene, 0.05, 0.02);
  MultigridSolver solver;
  ASSERT_TRUE(solver.prepare(cloth.run.system, cloth.clamped));
  Vec3Field solution(cloth.size()), image(cloth.size());
  ConjugateGradients gradients;
  const KrylovReport report = gradients.solve(
      cloth.run.system, cloth.exact,
      [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); }, cloth.residual(), 1e-8,
      solution);
  ASSERT_TRUE(report.indefinite);
  cloth.exact.multiply(cloth.run.system, gradients.direction(), image);
  double curvature = 0;
  for (std::size_t i = 0; i < cloth.size(); ++i) curvature += gradients.direction()[i].dot(image[i]);
  EXPECT_LE(curvature, 0);
}

TEST(BlockMultigrid, RefusesAMatrixThatIsNoNumber) {
  Crumpled cloth(sheet(20, 20), 0.02, 0.01);
  cloth.clamped.nodes.set(210, {std::nan(""), 0, 0, 1, 0, 1});
  MultigridSolver solver;
  EXPECT_FALSE(solver.prepare(cloth.run.system, cloth.clamped));
  Linearisation good;
  cloth.linearise(true, good);
  EXPECT_TRUE(solver.prepare(cloth.run.system, good)) << "what was no number is forgotten";
  Vec3Field x(cloth.size());
  solver.precondition(cloth.residual(), x);
  EXPECT_TRUE(all_finite(x));
}

}  // namespace
}  // namespace cloth::test::block_multigrid_test
