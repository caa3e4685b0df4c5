// Interpolation along a line from every second point, and a matrix on a grid interpolated by it.
#include "sparse/line_interpolation.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>

#include "kernels/instruction_set.h"
#include "sparse/block_coarsen_kernels.h"
#include "support/random.h"

namespace cloth::test::line_interpolation_test {
namespace {

/// A row for each list of weights.
Eigen::MatrixXd matrix_of(const LineWeights* lists, int rows, int columns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < lists[i].count; ++k) matrix(i, lists[i].first + k) = lists[i].weight[k];
  return matrix;
}
/// P
Eigen::MatrixXd matrix_of(const CoarseLine& line) {
  return matrix_of(line.parents, line.fine, line.coarse);
}

class EveryInterpolation : public ::testing::TestWithParam<Interpolation> {};
INSTANTIATE_TEST_SUITE_P(Lines, EveryInterpolation,
                         ::testing::Values(Interpolation::linear, Interpolation::cubic_splines),
                         [](const auto& of) {
                           return of.param == Interpolation::linear ? "linear" : "splines";
                         });

TEST_P(EveryInterpolation, HasTheSameWeightsForParentsAndChildren) {
  for (int points = 6; points < 20; ++points) {
    const LineInterpolation of(points, true, GetParam());
    EXPECT_EQ(of.coarse_points(), (points + 1) / 2);
    const CoarseLine line = of.line();
    EXPECT_EQ(matrix_of(line).transpose(), matrix_of(line.children, line.coarse, line.fine)) << points;
  }
}

TEST_P(EveryInterpolation, KeepsWhatIsConstant) {
  for (int points = 6; points < 20; ++points) {
    const LineInterpolation of(points, true, GetParam());
    const Eigen::VectorXd sums = matrix_of(of.line()).rowwise().sum();
    EXPECT_EQ(sums, Eigen::VectorXd::Ones(points)) << points;
  }
}

TEST_P(EveryInterpolation, LeavesALineThatIsNotHalvedAsItIs) {
  const LineInterpolation of(5, false, GetParam());
  EXPECT_EQ(matrix_of(of.line()), Eigen::MatrixXd::Identity(5, 5));
  EXPECT_EQ(of.line().regular_begin, of.line().regular_end) << "no mask fits";
}

TEST_P(EveryInterpolation, HasTheMaskWhereItSaysSo) {
  for (int points = 6; points < 20; ++points) {
    const LineInterpolation of(points, true, GetParam());
    const CoarseLine line = of.line();
    const Eigen::MatrixXd p = matrix_of(line);
    EXPECT_GE(line.regular_end - line.regular_begin, points - 3);
    for (int i = line.regular_begin; i < line.regular_end; ++i)
      for (int j = 0; j < line.coarse; ++j) {
        const int k = i - 2 * j + CoarseLine::mask_reach;
        EXPECT_EQ(p(i, j), k < 0 || k >= CoarseLine::mask_size ? 0.0 : line.mask[k]) << i << ' ' << j;
      }
  }
}

TEST(SplineInterpolation, KeepsAStraightLineUpToItsEnds) {
  for (int points = 6; points < 20; ++points) {
    const LineInterpolation of(points, true, Interpolation::cubic_splines);
    const Eigen::VectorXd coarse = Eigen::VectorXd::LinSpaced(of.coarse_points(), 0, of.coarse_points() - 1);
    const Eigen::VectorXd fine = matrix_of(of.line()) * coarse;
    for (int i = 0; i < points; ++i) EXPECT_EQ(fine(i), 0.5 * i) << points;
  }
}

/// Second differences of what comes from a parabola are all alike; linear ones are 0 and 1 by turns.
TEST(SplineInterpolation, BendsAsMuchAtEveryPoint) {
  const LineInterpolation of(21, true, Interpolation::cubic_splines);
  Eigen::VectorXd coarse(of.coarse_points());
  for (int j = 0; j < coarse.size(); ++j) coarse(j) = 4.0 * j * j;
  const Eigen::VectorXd fine = matrix_of(of.line()) * coarse;
  for (int i = 3; i < 18; ++i) EXPECT_EQ(fine(i - 1) - 2 * fine(i) + fine(i + 1), 2.0) << i;
}

// ---- On a grid ----

struct Blocks {
  Blocks(int rows, int columns, int reach) {
    natural.rows = rows, natural.columns = columns, natural.reach = reach;
    numbers.assign(static_cast<std::size_t>(6 * (1 + natural.couplings())) * count(), 0.0f);
    natural.numbers = numbers.data();
    std::fill(std::begin(natural.used), std::end(natural.used), false);
  }
  std::size_t count() const { return static_cast<std::size_t>(natural.particles()); }
  /// Number n of every block, as a dense matrix of one number for each particle.
  Eigen::MatrixXd dense(int n) const {
    const auto size = static_cast<Eigen::Index>(count());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
    for (int k = 0; k <= natural.couplings(); ++k) {
      const BlockCoupling c = natural.coupling(k);
      for (int row = 0; row + c.down < natural.rows && natural.used[k]; ++row)
        for (int column = std::max(0, -c.right); column < natural.columns - std::max(0, c.right); ++column) {
          const int i = row * natural.columns + column, j = i + c.down * natural.columns + c.right;
          result(i, j) = result(j, i) = natural.blocks_of(k)[n * natural.particles() + i];
        }
    }
    return result;
  }
  void fill(Random& random, const std::vector<int>& couplings) {
    for (const int k : couplings) {
      natural.used[k] = true;
      const BlockCoupling c = natural.coupling(k);
      for (int n = 0; n < 6; ++n)
        for (int row = 0; row + c.down < natural.rows; ++row)
          for (int column = std::max(0, -c.right); column < natural.columns - std::max(0, c.right); ++column)
            natural.blocks_of(k)[n * natural.particles() + row * natural.columns + column] =
                static_cast<float>(random.uniform(-1, 1));
    }
  }

  NaturalBlocks natural;
  std::vector<float> numbers;
};

Eigen::MatrixXd product_of(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd product(rows.rows() * columns.rows(), rows.cols() * columns.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    for (Eigen::Index j = 0; j < rows.cols(); ++j)
      product.block(i * columns.rows(), j * columns.cols(), columns.rows(), columns.cols()) =
          rows(i, j) * columns;
  return product;
}

class CoarsenedOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, CoarsenedOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

void expect_galerkins_product(int rows, int columns, int reach, Interpolation interpolation, Random& random,
                              const std::vector<int>& couplings) {
  SCOPED_TRACE(::testing::Message() << rows << " x " << columns << ", reach " << reach << ", "
                                    << (interpolation == Interpolation::linear ? "linear" : "splines"));
  Blocks fine(rows, columns, reach);
  fine.fill(random, couplings);
  const LineInterpolation down(rows, rows > 5, interpolation), right(columns, columns > 5, interpolation);
  Blocks coarse(down.coarse_points(), right.coarse_points(), interpolation == Interpolation::linear ? 2 : 3);
  std::vector<float> scratch(BlockCoarsenKernels::scratch(fine.natural, coarse.natural));
  active_kernels<BlockCoarsenKernels>().coarsen(fine.natural, down.line(), right.line(), coarse.natural,
                                                scratch.data());
  const Eigen::MatrixXd p = product_of(matrix_of(down.line()), matrix_of(right.line()));
  for (int n = 0; n < 6; ++n) {
    const Eigen::MatrixXd wanted = p.transpose() * fine.dense(n) * p;
    EXPECT_LE((coarse.dense(n) - wanted).cwiseAbs().maxCoeff(), 1e-5) << "number " << n;
  }
}

TEST_P(CoarsenedOfEverySet, IsGalerkinsProduct) {
  Random random;
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic_splines})
    for (const auto& [rows, columns] :
         {std::pair(6, 6), {7, 8}, {12, 13}, {5, 18}, {17, 4}, {9, 31}, {3, 40}})
      for (const int reach : {2, 3}) {
        if (reach == 3 && interpolation == Interpolation::linear) continue;
        NaturalBlocks of_reach;
        of_reach.reach = reach;
        std::vector<int> all;
        for (int k = 0; k <= of_reach.couplings(); ++k) all.push_back(k);
        expect_galerkins_product(rows, columns, reach, interpolation, random, all);
        expect_galerkins_product(
            rows, columns, reach, interpolation, random,
            {0, of_reach.number_of({0, 1}), of_reach.number_of({1, -1}), of_reach.number_of({2, 0})});
      }
}

}  // namespace
}  // namespace cloth::test::line_interpolation_test
