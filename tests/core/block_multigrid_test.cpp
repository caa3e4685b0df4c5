// Multigrid for the Jacobian of an implicit step on a grid, against dense algebra and Cholesky factors.
#include "sparse/block_multigrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/implicit/linear_choice.h"
#include "kernels/instruction_set.h"
#include "support/linearised_cloth.h"
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

TEST_P(JacobianOfEverySet, HasACycleThatIsSymmetricAndReducesEveryErrorInItsNorm) {
  for (const auto& [rows, columns] : {std::pair(9, 9), {8, 11}, {12, 7}, {6, 14}, {3, 17}, {4, 27}, {3, 41}})
    expect_a_cycle_that_reduces_every_error(sheet(rows, columns), 0.02, 0.01, 0.9);
}

TEST_P(JacobianOfEverySet, HasSuchACycleWhereBendingIsStifferThanSprings) {
  for (const auto& [rows, columns] : {std::pair(9, 9), {8, 11}, {12, 7}, {6, 14}, {3, 17}, {7, 25}}) {
    const Scene scene = paper(rows, columns);
    ASSERT_EQ(MultigridSolver::interpolation(DirectRun(scene, "implicit-euler").system),
              Interpolation::cubic_splines);
    expect_a_cycle_that_reduces_every_error(scene, 0.001, 1e-5, 0.9);
  }
}

// A strip of paper is not halved across, and a cycle takes less than a hundredth off its worst error.
TEST_P(JacobianOfEverySet, HasSuchACycleOnALongStrip) {
  expect_a_cycle_that_reduces_every_error(paper(3, 67), 0.001, 1e-5, 1);
}

TEST_P(JacobianOfEverySet, IsSolvedAsByFactorsInFewIterations) {
  for (const auto& [rows, columns] : {std::pair(33, 33), {40, 29}, {26, 64}})
    expect_the_solution_of_factors(sheet(rows, columns), 0.02, 0.003, 60);
}

TEST_P(JacobianOfEverySet, IsSolvedAsByFactorsWithAMaterialThatBends) {
  Material material;
  material.areal_density = 0.15, material.shear = 40;
  material.stretch_warp = 300, material.stretch_weft = 200;
  material.bending_warp = 2e-4, material.bending_weft = 1e-4, material.twist = 1e-4;
  material.bending_damping = 0.001;
  expect_the_solution_of_factors(sheet_of(material, 30, 31), 0.02, 0.003, 80);
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
  LinearisedCloth cloth(scene, 0.05, 0.02);
  MultigridSolver solver;
  ASSERT_TRUE(cloth.prepare(solver));
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
  LinearisedCloth cloth(sheet(20, 20), 0.02, 0.01);
  cloth.clamped.nodes.set(210, {std::nan(""), 0, 0, 1, 0, 1});
  MultigridSolver solver;
  EXPECT_FALSE(cloth.prepare(solver));
  Linearisation good;
  cloth.linearise(true, good);
  EXPECT_TRUE(solver.prepare(cloth.run.system, good, cloth.run.state.position))
      << "what was no number is forgotten";
  Vec3Field x(cloth.size());
  solver.precondition(cloth.residual(), x);
  EXPECT_TRUE(all_finite(x));
}

TEST(BlockMultigrid, ForgetsAResidualThatWasNoNumber) {
  const LinearisedCloth cloth(sheet(20, 20), 0.02, 0.01);
  MultigridSolver solver;
  ASSERT_TRUE(cloth.prepare(solver));
  Vec3Field before(cloth.size()), broken(cloth.size()), after(cloth.size());
  solver.precondition(cloth.residual(), before);
  Vec3Field residual = cloth.residual();
  residual.set(210, Vec3::Constant(std::nan("")));
  solver.precondition(residual, broken);
  EXPECT_FALSE(all_finite(broken));
  solver.precondition(cloth.residual(), after);
  EXPECT_TRUE(std::ranges::equal(before.flat(), after.flat()));
}

}  // namespace
}  // namespace cloth::test::block_multigrid_test
