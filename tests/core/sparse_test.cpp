// Orders of elimination and the block factors that rest on them.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <numeric>

#include "cloth/grid.h"
#include "geometry/dense_decompositions.h"
#include "kernels/instruction_set.h"
#include "sparse/block_cholesky.h"
#include "sparse/dense_kernels.h"
#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test::sparse_test {
namespace {

ClothSystem square_cloth(int size,
                         const SpringMaterial& springs = {.structural = 3, .shear = 2, .flexion = 1}) {
  ClothSheet sheet;
  sheet.rows = sheet.columns = size;
  sheet.pins = {NamedPin::top_left, NamedPin::top_right};
  return make_grid(sheet, springs);
}

/// Couplings between all particles, pinned or not.
std::vector<Coupling> couplings_of(const ClothSystem& system) {
  std::vector<Coupling> couplings;
  for (const SpringRun& run : system.springs)
    for (int i = run.first; i < run.first + run.count; ++i) couplings.emplace_back(i, i + run.offset);
  return couplings;
}

std::vector<int> all_particles(const ClothSystem& system) {
  std::vector<int> particles(static_cast<std::size_t>(system.size()));
  std::iota(particles.begin(), particles.end(), 0);
  return particles;
}

std::vector<int> sorted(std::vector<int> values) {
  std::sort(values.begin(), values.end());
  return values;
}

TEST(EliminationOrder, HoldsEveryFreeParticleOnce) {
  for (const int size : {2, 3, 5, 8, 13, 32, 41}) {
    const ClothSystem system = square_cloth(size);
    std::vector<int> free;
    for (const int i : all_particles(system))
      if (!system.pinned[static_cast<std::size_t>(i)]) free.push_back(i);
    EXPECT_EQ(sorted(elimination_order(system)), free) << size;
  }
}

TEST(EliminationOrder, OfSpringsThatReachFarHoldsEveryFreeParticleOnceToo) {
  ClothSystem system = square_cloth(12);
  system.springs.push_back({SpringFamily::flexion, 3, 1, 100, 1, 1});
  EXPECT_EQ(elimination_order(system).size(), 142u);
  EXPECT_EQ(sorted(elimination_order(system)), sorted(elimination_order(square_cloth(12))));
}

TEST(GridReach, IsOneAlongADiagonalOnlyWhereThereAreNoFlexionSprings) {
  EXPECT_EQ(reach_of(square_cloth(9)).along, (std::array{2, 2, 2, 2}));
  EXPECT_EQ(reach_of(square_cloth(9, {.structural = 3})).along, (std::array{1, 1, 1, 1}));
}

/// The unknowns of each front and of all below it.
std::vector<int> subtree_sizes(const EliminationTree& tree) {
  std::vector<int> sizes;
  for (const Front& front : tree.fronts) sizes.push_back(front.width);
  for (std::size_t f = 0; f < sizes.size(); ++f)
    if (tree.fronts[f].parent >= 0) sizes[static_cast<std::size_t>(tree.fronts[f].parent)] += sizes[f];
  return sizes;
}

TEST(NestedDissection, SeparatesAGridIntoPartsOfAtMostThreeQuarters) {
  for (const int size : {16, 33, 50}) {
    const ClothSystem system = square_cloth(size);
    const std::vector<int> order = nested_dissection(all_particles(system), system.columns, reach_of(system));
    const EliminationTree tree = analyse(couplings_of(system), order);
    const std::vector<int> sizes = subtree_sizes(tree);
    ASSERT_EQ(sizes.back(), system.size()) << "one tree";
    for (std::size_t f = 0; f + 1 < sizes.size(); ++f) {
      if (tree.fronts[f].parent != static_cast<int>(sizes.size()) - 1) continue;
      EXPECT_LE(4 * sizes[f], 3 * system.size()) << size;
    }
    EXPECT_LE(tree.fronts.back().width, 4 * size) << "a separator of two lines, and what was merged with it";
  }
}

TEST(NestedDissection, NeedsFewerOperationsThanMinimumDegreeAndThanRowByRow) {
  for (const int size : {33, 64, 97}) {
    const ClothSystem system = square_cloth(size);
    const std::vector<Coupling> couplings = couplings_of(system);
    const auto operations = [&](const std::vector<int>& order) {
      BlockCholesky factors(3);
      factors.analyse(couplings, order);
      return factors.operations();
    };
    const double dissected =
        operations(nested_dissection(all_particles(system), system.columns, reach_of(system)));
    EXPECT_LT(dissected, 0.95 * operations(minimum_degree(system.size(), couplings))) << size;
    EXPECT_LT(dissected, 0.75 * operations(all_particles(system))) << size;
  }
}

TEST(EliminationTree, JoinsCoupledUnknownsByOnePathToTheRoot) {
  const ClothSystem system = square_cloth(20);
  const std::vector<Coupling> couplings = couplings_of(system);
  for (const std::vector<int>& order : {all_particles(system), minimum_degree(system.size(), couplings)}) {
    const EliminationTree tree = analyse(couplings, order);
    EXPECT_EQ(sorted(tree.place), all_particles(system));
    for (const auto& [i, j] : couplings) {
      const int low =
          std::min(tree.place[static_cast<std::size_t>(i)], tree.place[static_cast<std::size_t>(j)]);
      const int high =
          std::max(tree.place[static_cast<std::size_t>(i)], tree.place[static_cast<std::size_t>(j)]);
      const auto front = std::find_if(tree.fronts.begin(), tree.fronts.end(), [&](const Front& f) {
        return low >= f.first && low < f.first + f.width;
      });
      EXPECT_TRUE(high < front->first + front->width ||
                  std::binary_search(front->rows.begin(), front->rows.end(), high));
    }
  }
}

/// A random matrix of blocks on a random graph, as the factors take it and as a dense matrix.
struct RandomMatrix {
  std::vector<Coupling> couplings;
  std::vector<double> diagonal, off_diagonal;
  Eigen::MatrixXd dense;
};

Eigen::MatrixXd random_block(int block, Random& random) {
  const Eigen::MatrixXd any =
      Eigen::MatrixXd::NullaryExpr(block, block, [&] { return random.uniform(-1, 1); });
  return any + any.transpose();
}

/// Positive definite by dominance, and just not where `weakest` makes a diagonal block negative.
RandomMatrix random_matrix(int unknowns, int block, Random& random) {
  RandomMatrix matrix;
  matrix.dense = Eigen::MatrixXd::Zero(unknowns * block, unknowns * block);
  for (int k = 0; k < 4 * unknowns; ++k) {
    const int i = static_cast<int>(random.uniform(0, unknowns)),
              j = static_cast<int>(random.uniform(0, unknowns));
    if (i == j) continue;
    matrix.couplings.emplace_back(i, j);  // some of them more than once
    const Eigen::MatrixXd b = random_block(block, random);
    matrix.off_diagonal.insert(matrix.off_diagonal.end(), b.data(), b.data() + b.size());
    matrix.dense.block(i * block, j * block, block, block) += b;
    matrix.dense.block(j * block, i * block, block, block) += b;
  }
  for (int i = 0; i < unknowns * block; ++i) matrix.dense(i, i) = 1 + matrix.dense.row(i).cwiseAbs().sum();
  for (int i = 0; i < unknowns; ++i) {
    const Eigen::MatrixXd b = matrix.dense.block(i * block, i * block, block, block);
    matrix.diagonal.insert(matrix.diagonal.end(), b.data(), b.data() + b.size());
  }
  return matrix;
}

TEST(BlockCholesky, SolvesAsDenseFactorsDoForEveryBlockSizeAndManyRightHandSides) {
  Random random;
  for (const int block : {1, 2, 3}) {
    for (const int unknowns : {1, 2, 7, 40, 90}) {
      const RandomMatrix matrix = random_matrix(unknowns, block, random);
      BlockCholesky factors(block);
      factors.analyse(matrix.couplings, minimum_degree(unknowns, matrix.couplings));
      ASSERT_TRUE(factors.factorise(matrix.diagonal, matrix.off_diagonal));
      const Eigen::MatrixXd b =
          Eigen::MatrixXd::NullaryExpr(unknowns * block, 3, [&] { return random.uniform(-1, 1); });
      Eigen::MatrixXd x = b;
      factors.solve({x.data(), static_cast<std::size_t>(x.size())}, 3);
      EXPECT_LE((x - matrix.dense.llt().solve(b)).norm(), 1e-12 * x.norm()) << block << " " << unknowns;
    }
  }
}

TEST(BlockCholesky, SaysThatAMatrixIsNotPositiveDefiniteAndFactorsTheNextOne) {
  Random random;
  const RandomMatrix matrix = random_matrix(30, 3, random);
  BlockCholesky factors(3);
  factors.analyse(matrix.couplings, minimum_degree(30, matrix.couplings));
  const double smallest = symmetric_values(matrix.dense).minCoeff();
  const auto shifted = [&](double shift) {
    std::vector<double> diagonal = matrix.diagonal;
    for (std::size_t i = 0; i < 30; ++i)
      for (std::size_t k = 0; k < 3; ++k) diagonal[9 * i + 4 * k] -= shift;
    return diagonal;
  };
  EXPECT_TRUE(factors.factorise(shifted(0.999 * smallest), matrix.off_diagonal));
  EXPECT_FALSE(factors.factorise(shifted(1.001 * smallest), matrix.off_diagonal));
  EXPECT_TRUE(factors.factorise(shifted(0), matrix.off_diagonal));
}

TEST(DenseKernels, GiveTheSameBitsForEveryInstructionSet) {
  Random random;
  for (const int height : {1, 5, 37, 130}) {
    const int width = std::max(1, height / 2), rest = height - width;
    const auto stride = static_cast<std::size_t>(height);
    std::vector<double> start(stride * static_cast<std::size_t>(width));
    for (double& value : start) value = random.uniform(-1, 1);
    for (int k = 0; k < width; ++k) start[static_cast<std::size_t>(k) * (stride + 1)] += height;
    std::map<InstructionSet, std::vector<double>> fronts, updates;
    for (const InstructionSet set : supported_instruction_sets()) {
      set_instruction_set(set);
      const DenseKernels& kernels = active_kernels<DenseKernels>();
      std::vector<double>& front = fronts[set] = start;
      std::vector<double>& update = updates[set];
      update.assign(static_cast<std::size_t>(rest) * static_cast<std::size_t>(rest), 1);
      ASSERT_TRUE(kernels.factorise_columns({front.data(), stride}, height, width));
      kernels.subtract_square({update.data(), static_cast<std::size_t>(rest)}, {front.data() + width, stride},
                              rest, width);
      for (int column = 0; column < rest; ++column)  // above the diagonal stands nothing of meaning
        for (int row = 0; row < column; ++row) update[static_cast<std::size_t>(row + column * rest)] = 0;
      for (int column = 0; column < width; ++column)
        for (int row = 0; row < column; ++row) front[static_cast<std::size_t>(row + column * height)] = 0;
      EXPECT_EQ(front, fronts[InstructionSet::portable]) << name_of(set) << " " << height;
      EXPECT_EQ(update, updates[InstructionSet::portable]) << name_of(set) << " " << height;
    }
    set_instruction_set(std::nullopt);
  }
}

}  // namespace
}  // namespace cloth::test::sparse_test
