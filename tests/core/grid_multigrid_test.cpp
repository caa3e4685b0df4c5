// Matrices on grids, their coarser ones and the cycle of multigrid, against the same by dense algebra.
#include "sparse/grid_multigrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/dense_decompositions.h"
#include "kernels/instruction_set.h"
#include "support/random.h"

namespace cloth::test::grid_multigrid_test {
namespace {

/// A sheet of springs over a grid, as projective dynamics has it: mass + stiffness, some particles fixed.
struct Sheet {
  int rows = 0, columns = 0;
  double mass = 1, structural = 20, shear = 10, flexion = 5;
  std::vector<std::size_t> fixed = {};
  double heavier = 0;  ///< how much stiffness grows from the first to the last particle
};

GridStencils stencils_of(const Sheet& sheet) {
  GridStencils a(sheet.rows, sheet.columns);
  std::vector<bool> fixed(a.count(), false);
  for (const std::size_t i : sheet.fixed) fixed[i] = true;
  const auto couple = [&](int r, int c, int down, int right, double k) {
    if (r + down >= sheet.rows || c + right < 0 || c + right >= sheet.columns || k == 0) return;
    const auto i = static_cast<std::size_t>(r * sheet.columns + c);
    const auto j = static_cast<std::size_t>((r + down) * sheet.columns + c + right);
    k *= 1 + sheet.heavier * static_cast<double>(i) / static_cast<double>(a.count());
    if (!fixed[i]) a.add_to_diagonal(i, k);
    if (!fixed[j]) a.add_to_diagonal(j, k);
    if (fixed[i] || fixed[j]) return;
    EXPECT_TRUE(a.add_coupling(i, j, -k));
  };
  for (int r = 0; r < sheet.rows; ++r)
    for (int c = 0; c < sheet.columns; ++c) {
      const auto i = static_cast<std::size_t>(r * sheet.columns + c);
      if (!fixed[i]) a.add_to_diagonal(i, sheet.mass);
      couple(r, c, 0, 1, sheet.structural), couple(r, c, 1, 0, sheet.structural);
      couple(r, c, 1, 1, sheet.shear), couple(r, c, 1, -1, sheet.shear);
      couple(r, c, 0, 2, sheet.flexion), couple(r, c, 2, 0, sheet.flexion);
    }
  return a;
}

Eigen::MatrixXd dense(const GridStencils& a) {
  const auto size = static_cast<Eigen::Index>(a.count());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int r = 0; r < a.rows(); ++r)
    for (int c = 0; c < a.columns(); ++c)
      for (int k = 0; k < GridStencils::size; ++k) {
        const int i = r * a.columns() + c;
        const int r2 = r + GridStencils::rows_of(k), c2 = c + GridStencils::columns_of(k);
        const double value = a(k, static_cast<std::size_t>(i));
        if (value == 0) continue;
        EXPECT_TRUE(r2 >= 0 && r2 < a.rows() && c2 >= 0 && c2 < a.columns()) << "outside of the grid";
        matrix(i, r2 * a.columns() + c2) = value;
      }
  return matrix;
}

/// The interpolation of a line: every point on its own, the ones between from both sides or the only one.
Eigen::MatrixXd line_interpolation(int fine, int coarse) {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(fine, coarse);
  for (int i = 0; i < fine; ++i) {
    if (fine == coarse) {
      p(i, i) = 1;
    } else if (i % 2 == 0) {
      p(i, i / 2) = 1;
    } else if (i / 2 + 1 < coarse) {
      p(i, i / 2) = p(i, i / 2 + 1) = 0.5;
    } else {
      p(i, i / 2) = 1;
    }
  }
  return p;
}

const std::vector<Sheet> sheets{{9, 9},
                                {8, 11, 1, 20, 10, 5, {0, 10}},
                                {12, 7, 0.01, 3, 1, 0.1, {3, 40, 41}},
                                {6, 20, 1, 1, 0, 7, {0}, 3},
                                {3, 17, 1, 20, 10, 5, {0, 16}, 1}};

TEST(GridStencils, CoarsenToThePProductWithInterpolationFromEverySecondRowAndColumn) {
  for (const Sheet& sheet : sheets) {
    const GridStencils fine = stencils_of(sheet), coarse = fine.coarsened(5);
    EXPECT_EQ(coarse.rows(), sheet.rows > 5 ? (sheet.rows + 1) / 2 : sheet.rows);
    const Eigen::MatrixXd down = line_interpolation(fine.rows(), coarse.rows());
    const Eigen::MatrixXd right = line_interpolation(fine.columns(), coarse.columns());
    const auto size = static_cast<Eigen::Index>(fine.count());
    Eigen::MatrixXd p(size, static_cast<Eigen::Index>(coarse.count()));
    for (int i = 0; i < static_cast<int>(size); ++i)
      for (int j = 0; j < static_cast<int>(coarse.count()); ++j) {
        const bool is_free = fine.is_free(static_cast<std::size_t>(i));
        p(i, j) = is_free ? down(i / fine.columns(), j / coarse.columns()) *
                                right(i % fine.columns(), j % coarse.columns())
                          : 0;
      }
    EXPECT_LE((dense(coarse) - p.transpose() * dense(fine) * p).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(GridStencils, MultiplyAsTheDenseMatrixDoes) {
  Random random;
  for (const Sheet& sheet : sheets) {
    const GridStencils a = stencils_of(sheet);
    std::vector<double> x(a.count()), product;
    for (double& number : x) number = random.normal(1);
    a.multiply(x, product);
    const Eigen::Map<const Eigen::VectorXd> given(x.data(), static_cast<Eigen::Index>(x.size()));
    const Eigen::VectorXd expected = dense(a) * given;
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(product[i], expected[static_cast<Eigen::Index>(i)], 1e-12);
  }
}

TEST(GridStencils, RefuseACouplingThatReachesThreeRowsOrColumns) {
  GridStencils a(6, 6);
  EXPECT_FALSE(a.add_coupling(0, 3, -1));
  EXPECT_FALSE(a.add_coupling(0, 18, -1));
  EXPECT_FALSE(a.add_coupling(5, 6, -1)) << "neighbours in memory, at opposite borders";
  EXPECT_TRUE(a.add_coupling(2, 12, -1));
}

class CycleOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, CycleOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

/// The matrix of a cycle, column by column: three of them at once.
Eigen::MatrixXd cycle_matrix(GridMultigrid& multigrid, const GridStencils& a) {
  const auto size = static_cast<Eigen::Index>(a.count());
  Eigen::MatrixXd b(size, size);
  for (Eigen::Index column = 0; column < size; column += 3) {
    Vec3Field unit(a.count()), x(a.count());
    for (Eigen::Index q = 0; q < 3 && column + q < size; ++q)
      if (a.is_free(static_cast<std::size_t>(column + q)))
        unit.flat()[static_cast<std::size_t>(q * size + column + q)] = 1;
    multigrid.solve(unit, x);
    for (Eigen::Index q = 0; q < 3 && column + q < size; ++q)
      for (Eigen::Index i = 0; i < size; ++i)
        b(i, column + q) = x.flat()[static_cast<std::size_t>(q * size + i)];
  }
  return b;
}

// With A = L L^T the error after a cycle, I - B A, has the norm of I - L^T B L in the norm of A.
TEST_P(CycleOfEverySet, ReducesEveryErrorInTheNormOfTheMatrix) {
  for (const Sheet& sheet : sheets) {
    const GridStencils a = stencils_of(sheet);
    GridMultigrid multigrid;
    ASSERT_TRUE(multigrid.prepare(a));
    Eigen::MatrixXd matrix = dense(a), cycle = cycle_matrix(multigrid, a);
    for (const std::size_t fixed : sheet.fixed) {
      const auto i = static_cast<Eigen::Index>(fixed);
      matrix(i, i) = cycle(i, i) = 1;
    }
    const Eigen::MatrixXd root = cholesky_factor(matrix).value();
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()) -
                                 Eigen::MatrixXd(root.transpose() * cycle * root);
    const double norm = spectral_norm(left);
    EXPECT_LT(norm, 0.8) << sheet.rows << " x " << sheet.columns;
  }
}

TEST_P(CycleOfEverySet, ReducesTheErrorByTheFactorThatIsMeasured) {
  Random random;
  for (const Sheet& sheet : sheets) {
    const GridStencils a = stencils_of(sheet);
    GridMultigrid multigrid;
    ASSERT_TRUE(multigrid.prepare(a));
    const double factor = multigrid.convergence_factor();
    EXPECT_LT(factor, 0.6);
    EXPECT_EQ(factor, multigrid.convergence_factor()) << "the same for the same matrix";
    const Vec3Field wanted = [&] {
      Vec3Field field = random.field(a.count(), 1);
      for (const std::size_t i : sheet.fixed) field.set(i, Vec3::Zero());
      return field;
    }();
    const Eigen::MatrixXd matrix = dense(a);
    Vec3Field x(a.count()), residual(a.count()), correction(a.count());
    const auto error = [&] {
      double square = 0;
      for (std::size_t i = 0; i < a.count(); ++i) square += (x[i] - wanted[i]).squaredNorm();
      return std::sqrt(square);
    };
    const double before = error();
    constexpr int cycles = 8;
    for (int n = 0; n < cycles; ++n) {
      for (int q = 0; q < 3; ++q) {
        const auto size = static_cast<Eigen::Index>(a.count());
        const Eigen::Map<const Eigen::VectorXd> goal(wanted.x() + q * size, size),
            now(x.x() + q * size, size);
        Eigen::Map<Eigen::VectorXd>(residual.x() + q * size, size) = matrix * (goal - now);
      }
      multigrid.solve(residual, correction);
      for (std::size_t i = 0; i < a.count(); ++i) x.add(i, correction[i]);
    }
    EXPECT_LT(error(), std::pow(factor + 0.1, cycles) * before) << sheet.rows << " x " << sheet.columns;
  }
}

TEST_P(CycleOfEverySet, MeetsTheSumOfTheRightHandSideToRounding) {
  Random random;
  Sheet sheet{23, 34};
  const GridStencils a = stencils_of(sheet);
  GridMultigrid multigrid;
  ASSERT_TRUE(multigrid.prepare(a));
  const Vec3Field b = random.field(a.count(), 1);
  Vec3Field x(a.count());
  multigrid.solve(b, x);
  Vec3 missing = Vec3::Zero();  // without pins 1^T A = mass 1^T
  for (std::size_t i = 0; i < a.count(); ++i) missing += b[i] - sheet.mass * x[i];
  EXPECT_LE(missing.norm(), 1e-11);
}

TEST_P(CycleOfEverySet, LeavesFixedParticlesAndMakesTheSameBitsTwice) {
  Random random;
  for (const Sheet& sheet : sheets) {
    const GridStencils a = stencils_of(sheet);
    GridMultigrid one, other;
    ASSERT_TRUE(one.prepare(a));
    ASSERT_TRUE(other.prepare(a));
    Vec3Field b = random.field(a.count(), 1), x(a.count()), y(a.count());
    for (const std::size_t i : sheet.fixed) b.set(i, Vec3::Zero());
    one.solve(random.field(a.count(), 1e20), y);  // what it leaves behind has no say
    one.solve(b, x), other.solve(b, y);
    EXPECT_EQ(x, y);
    for (const std::size_t i : sheet.fixed) EXPECT_EQ(x[i].norm(), 0);
  }
}

TEST(GridMultigrid, RefusesADiagonalThatIsNegativeOrNoNumber) {
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    GridStencils a = stencils_of({9, 9});
    a.add_to_diagonal(40, bad - a(GridStencils::middle, 40));
    GridMultigrid multigrid;
    EXPECT_FALSE(multigrid.prepare(a)) << bad;
  }
}

TEST(GridMultigrid, SeesThatShearAloneIsNotForIt) {
  GridMultigrid good, bad;
  ASSERT_TRUE(good.prepare(stencils_of({33, 33, 1, 800, 400, 100})));
  ASSERT_TRUE(bad.prepare(stencils_of({33, 33, 1, 1, 800, 0})));
  EXPECT_LT(good.convergence_factor(), 0.3);
  EXPECT_GT(bad.convergence_factor(), 0.7);
}

}  // namespace
}  // namespace cloth::test::grid_multigrid_test
