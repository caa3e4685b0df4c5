// The linear systems that clothlab-solvers-bench takes, and that every solver of it solves them.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/solvers/linear_subject.h"
#include "bench/solvers/solver_study.h"

namespace cloth::solvers::solvers_test {
namespace {

class SystemOfNewton : public testing::TestWithParam<ClothShape> {};

TEST_P(SystemOfNewton, InRowsIsTheMatrixThatOursMultipliesWith) {
  const auto system = newton_system(GetParam(), 9);
  RowPattern pattern(system->system);
  const SparseRows& rows = pattern.fill(system->system, system->matrix);
  Vec3Field direction(system->right_hand_side.size()), product(direction.size());
  for (const int particle : rows.particle)
    direction.set(static_cast<std::size_t>(particle), {std::sin(particle), std::cos(3 * particle), 1});
  system->matrix.multiply(system->system, direction, product);
  const std::vector<double> x = packed(rows, direction), b = packed(rows, product);
  double largest = 0;
  for (const double value : b) largest = std::max(largest, std::abs(value));
  for (int row = 0; row < rows.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    double sum = 0;
    for (int at = rows.begin[r]; at < rows.begin[r + 1]; ++at)
      sum += rows.value[static_cast<std::size_t>(at)] * x[static_cast<std::size_t>(rows.column[at])];
    EXPECT_NEAR(sum, b[r], 1e-12 * largest);
  }
  Vec3Field back(direction.size());
  unpack(rows, x, back);
  EXPECT_EQ(back, direction);
}

TEST_P(SystemOfNewton, IsTheSameEveryTimeAndHasARightHandSideOnFreeParticlesAlone) {
  const auto once = newton_system(GetParam(), 9), again = newton_system(GetParam(), 9);
  EXPECT_EQ(once->right_hand_side, again->right_hand_side);
  EXPECT_EQ(once->relative_residual(Vec3Field(81)), 1);
  for (std::size_t i = 0; i < 81; ++i)
    if (once->system.pinned[i]) {
      EXPECT_EQ(once->right_hand_side[i].norm(), 0);
    }
  EXPECT_GT(once->compressed_part, 0.1) << "a matrix with clamped springs is another one";
}

INSTANTIATE_TEST_SUITE_P(Shapes, SystemOfNewton, testing::ValuesIn(cloth_shapes));

TEST(Solvers, AllReachTheResidualThatIsAskedFor) {
  SolverOptions options;
  options.sizes = {11};
  options.repeats = 1;
  options.quick = true;
  const SolverReport report = study_solvers(options);
  EXPECT_TRUE(report.complete);
  ASSERT_EQ(report.tables.size(), std::size(cloth_shapes));
  for (const SolverTable& table : report.tables) {
    EXPECT_EQ(table.rows.size(), 6u - (report.missing.size() == 2            ? 3
                                       : report.missing.size() == 0          ? 0
                                       : report.missing[0] == "libhypre-dev" ? 2
                                                                             : 1));
    for (const SolverRow& row : table.rows) {
      EXPECT_EQ(row.failure, "") << row.name;
      EXPECT_LE(row.residual, 1e-6) << row.name;
      EXPECT_GT(row.set_up.median, 0) << row.name;
      EXPECT_GT(row.solve.median, 0) << row.name;
      EXPECT_EQ(row.conversion.median > 0, !row.is_ours()) << row.name;
    }
    ASSERT_NE(table.best_of_ours(), nullptr);
    EXPECT_TRUE(table.best_of_ours()->is_ours());
  }
  for (const bool markdown : {false, true})
    EXPECT_NE(solver_text(report, markdown).find("buckled"), std::string::npos);
  EXPECT_NE(solver_json(report).find("\"set_up_ms\""), std::string::npos);
}

}  // namespace
}  // namespace cloth::solvers::solvers_test
