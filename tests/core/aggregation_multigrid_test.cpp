// Multigrid by smoothed aggregation for the Jacobian of an implicit step on a mesh, and what it is made of.
#include "sparse/aggregation_multigrid.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>

#include "geometry/at.h"
#include "kernels/instruction_set.h"
#include "support/linearised_cloth.h"
#include "support/material_meshes.h"
#include "support/states.h"

namespace cloth::test::aggregation_multigrid_test {
namespace {

class MeshJacobianOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, MeshJacobianOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

Material knit() {
  Material material;
  material.areal_density = 0.2, material.shear = 30;
  material.stretch_warp = 120, material.stretch_weft = 60;
  material.bending_warp = 2e-5, material.bending_weft = 1e-5, material.twist = 1e-5;
  return material;
}

Scene sheet_of_material(int side) {
  Random random;
  Scene scene = material_mesh_sheet(side, side, 1, 1, 0.3, knit(), random);
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, side - 1}};
  return scene;
}

Scene sheet_of_springs(int side) {
  Scene scene = sheet_of_material(side);
  scene.material.reset();
  scene.cloth.mass = 0.25;
  scene.springs = SpringMaterial{.structural = 1000, .shear = 0, .flexion = 100};
  return scene;
}

Scene knit_cut_round(int side) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = side;
  scene.cloth.cut = "round";
  scene.cloth.pins.clear();
  scene.material = knit();
  return scene;
}

TEST_P(MeshJacobianOfEverySet, HasACycleThatIsSymmetricAndReducesEveryErrorInItsNorm) {
  for (const Scene& scene : {sheet_of_springs(3), sheet_of_springs(6), sheet_of_springs(11),
                             sheet_of_material(6), sheet_of_material(11), knit_cut_round(11)})
    expect_a_cycle_that_reduces_every_error(scene, 1.0 / 60, 0.002, 0.97);
}

TEST_P(MeshJacobianOfEverySet, IsSolvedAsByFactorsInFewIterations) {
  expect_the_solution_of_factors(sheet_of_springs(30), 1.0 / 60, 0.003, 40);
  expect_the_solution_of_factors(sheet_of_material(30), 1.0 / 60, 0.003, 80);
  expect_the_solution_of_factors(knit_cut_round(30), 1.0 / 60, 0.003, 80);
}

/// Every particle a fiftieth of a cell off its place.
int iterations_of(const Scene& scene, int side) {
  return iterations_to_a_thousandth(scene, 1.0 / 60, 0.02 / side);
}

TEST(AggregationMultigrid, NeedsHardlyMoreIterationsOnFinerMeshes) {
  std::vector<int> springs, material;
  for (const int side : {17, 33, 65}) {
    springs.push_back(iterations_of(sheet_of_springs(side), side));
    material.push_back(iterations_of(sheet_of_material(side), side));
  }
  for (const std::vector<int>& iterations : {springs, material}) {
    EXPECT_GT(iterations[0], 1);
    EXPECT_LE(iterations[1], iterations[0] + 4);
    EXPECT_LE(iterations[2], iterations[1] + 4);
  }
}

/// What is heavy against its springs is nearly diagonal, what is light nearly free to move as a whole.
TEST(AggregationMultigrid, NeedsFewIterationsAtEveryStiffness) {
  for (double stiffness = 1; stiffness <= 1e10; stiffness *= 100) {
    Scene scene = sheet_of_springs(30);
    scene.cloth.pins.clear();
    scene.springs->structural = stiffness, scene.springs->flexion = 0.1 * stiffness;
    const int iterations = iterations_of(scene, 30);
    EXPECT_GE(iterations, 1) << "k = " << stiffness;
    EXPECT_LE(iterations, 20) << "k = " << stiffness;
  }
}

TEST(AggregationMultigrid, SolvesForACloudOfParticlesWithoutNeighbours) {
  const int size = 30;
  std::vector<double> diagonal(9 * size, 0.0), positions(3 * size, 0.0), residual, correction(3 * size);
  for (int i = 0; i < size; ++i)
    for (int c = 0; c < 3; ++c) diagonal[at(9 * i + 4 * c)] = 2 + i, residual.push_back(c + 1);
  AggregationMultigrid multigrid;
  multigrid.analyse(size, {}, {});
  ASSERT_TRUE(multigrid.prepare(diagonal, {}, positions));
  multigrid.solve(residual, correction);
  for (int i = 0; i < size; ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(correction[at(3 * i + c)], (c + 1) / (2.0 + i), 1e-6) << "particle " << i;
}

TEST(AggregationMultigrid, SolvesForNoParticleAtAll) {
  AggregationMultigrid multigrid;
  multigrid.analyse(0, {}, {});
  ASSERT_TRUE(multigrid.prepare({}, {}, {}));
  multigrid.solve({}, {});
}

TEST(AggregationMultigrid, RefusesAMatrixThatIsNoNumberAndOneThatIsNotPositive) {
  for (const double wrong : {std::nan(""), -1e3}) {
    LinearisedCloth cloth(sheet_of_springs(20), 1.0 / 60, 0.001);
    cloth.clamped.nodes.set(210, {wrong, 0, 0, 1, 0, 1});
    MultigridSolver solver;
    EXPECT_FALSE(cloth.prepare(solver));
    cloth.linearise(true, cloth.clamped);
    EXPECT_TRUE(cloth.prepare(solver)) << "what was wrong is forgotten";
    Vec3Field x(cloth.size());
    solver.precondition(cloth.residual(), x);
    EXPECT_TRUE(all_finite(x));
  }
}

TEST(AggregationMultigrid, FollowsPinsThatChange) {
  LinearisedCloth cloth(sheet_of_springs(20), 1.0 / 60, 0.001);
  MultigridSolver solver;
  ASSERT_TRUE(cloth.prepare(solver));
  cloth.run.system.pinned[210] = 1;
  ASSERT_TRUE(cloth.prepare(solver));
  Vec3Field x(cloth.size());
  solver.precondition(cloth.residual(), x);
  EXPECT_EQ(x[210], Vec3(Vec3::Zero()));
  EXPECT_NE(x[211], Vec3(Vec3::Zero()));
}

/// A random graph, with some points alone.
SparsePattern random_graph(int size, Random& random) {
  std::vector<Coupling> edges;
  for (int k = 0; k < size; ++k) {
    const int i = random.integer(0, size * 3 / 4), j = random.integer(0, size * 3 / 4);
    if (i != j) edges.emplace_back(i, j);
  }
  return symmetric_pattern(size, edges);
}

TEST(Aggregates, HoldEveryPointWithNeighboursOnceAndNoneWithout) {
  Random random;
  for (const int size : {1, 2, 7, 40, 200}) {
    const SparsePattern graph = random_graph(size, random);
    const Aggregates aggregates = aggregate(graph);
    std::multiset<int> members(aggregates.members.column.begin(), aggregates.members.column.end());
    for (int i = 0; i < size; ++i) {
      const bool is_alone = graph.row(i).size() == 1;
      EXPECT_EQ(members.count(i), is_alone ? 0u : 1u);
      EXPECT_EQ(aggregates.of[at(i)] >= 0, !is_alone);
    }
    for (int a = 0; a < aggregates.count(); ++a) {
      EXPECT_GE(aggregates.members.row(a).size(), 2u);
      for (const int i : aggregates.members.row(a)) EXPECT_EQ(aggregates.of[at(i)], a);
    }
    const SparsePattern coarse = graph_of(aggregates, graph);
    for (int i = 0; i < size; ++i)
      for (const int j : graph.row(i)) {
        const int a = aggregates.of[at(i)], b = aggregates.of[at(j)];
        if (a < 0 || b < 0) continue;
        const std::span<const int> row = coarse.row(a);
        EXPECT_TRUE(std::binary_search(row.begin(), row.end(), b)) << "an edge joins " << a << " and " << b;
      }
  }
}

Eigen::MatrixXd dense(const SparsePattern& pattern, int columns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pattern.rows(), columns);
  for (int i = 0; i < pattern.rows(); ++i)
    for (const int j : pattern.row(i)) matrix(i, j) = 1;
  return matrix;
}

TEST(SparsePattern, OfATransposeAndOfAProductIsThatOfTheMatrices) {
  Random random;
  SparsePattern a, b;
  std::vector<int> row;
  for (int i = 0; i < 12; ++i) {
    row.clear();
    for (int k = random.integer(0, 4); k > 0; --k) row.push_back(random.integer(0, 8));
    a.add_row(row);
  }
  for (int i = 0; i < 9; ++i) {
    row.clear();
    for (int k = random.integer(0, 4); k > 0; --k) row.push_back(random.integer(0, 6));
    b.add_row(row);
  }
  EXPECT_EQ(dense(transposed(a, 9), 12), dense(a, 9).transpose());
  const Eigen::MatrixXd expected = (dense(a, 9) * dense(b, 7)).cwiseMin(1);
  EXPECT_EQ(dense(product(a, b), 7), expected);
}

TEST(Aggregates, SpanTheirModesWithColumnsOfLengthOneThatAreOrthogonal) {
  Random random;
  const int size = 60;
  const SparsePattern graph = random_graph(size, random);
  const Aggregates aggregates = aggregate(graph);
  for (const std::size_t block : {3, 6}) {
    std::vector<double> modes, basis, coarse;
    for (std::size_t k = 0; k < size * block * 6; ++k) modes.push_back(random.uniform(-1, 1));
    orthonormalise(aggregates, block, modes, basis, coarse);
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
    using Square = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    const auto rows = static_cast<Eigen::Index>(block);
    for (int a = 0; a < aggregates.count(); ++a) {
      const Eigen::Map<const Square> of_coarse(coarse.data() + 36 * at(a));
      Eigen::MatrixXd overlap = Eigen::MatrixXd::Zero(6, 6);
      for (const int i : aggregates.members.row(a)) {
        const std::size_t first = at(i) * block * 6;
        const Eigen::Map<const Rows> of_modes(modes.data() + first, rows, 6),
            of_basis(basis.data() + first, rows, 6);
        overlap += of_basis.transpose() * of_basis;
        EXPECT_LE((of_basis * of_coarse - of_modes).norm(), 1e-2) << "random ones may nearly depend";
      }
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) EXPECT_NEAR(overlap(r, c), r == c && overlap(c, c) > 0.5 ? 1 : 0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace cloth::test::aggregation_multigrid_test
