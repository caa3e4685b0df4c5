// XPBD's visits of a grid's springs by the kernels, in every instruction set that this machine has, against
// springs visited one by one in the order that kernels/grid_projection.h promises.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "cloth/grid.h"
#include "kernels/grid_sweep.h"
#include "kernels/instruction_set.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::grid_projection_test {
namespace {

class ProjectionOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, ProjectionOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

constexpr std::pair<int, int> sizes[] = {{2, 2},   {2, 3},   {3, 2},  {3, 17},  {7, 9},  {33, 33}, {40, 7},
                                         {12, 10}, {65, 64}, {2, 70}, {11, 41}, {20, 6}, {5, 19},  {6, 32}};

struct Direction {
  int down, right;
};

/// The springs of a grid visited one after the other, by index pairs.
class OneByOne {
 public:
  OneByOne(const Scene& scene, const ClothSystem& system, double step, const std::vector<double>& mobility,
           const Vec3Field& position, Vec3Field velocity)
      : columns_(scene.cloth.columns),
        rows_(scene.cloth.rows),
        damping_(scene.springs->damping),
        step_(step),
        mobility_(mobility),
        position_(position),
        velocity_(std::move(velocity)) {
    for (const SpringPair& spring : springs_of(system))
      springs_.insert({std::minmax(spring.i, spring.j), spring});
  }

  Vec3Field run() {
    for (int row = 0; row < rows_; ++row) {
      for (const int start : {0, 1})
        for (int column = start; column + 1 < columns_; column += 2) visit(row, column, {0, 1});
      for (const int start : {0, 2})
        for (int column = 0; column + 2 < columns_; ++column)
          if (column % 4 / 2 == start / 2) visit(row, column, {0, 2});
    }
    for (const Direction d : {Direction{1, 0}, {1, 1}, {1, -1}})
      for (const int turn : {0, 1})
        for (int row = turn; row + 1 < rows_; row += 2) visit_row(row, d);
    for (const int turn : {0, 1})
      for (int row = 0; row + 2 < rows_; ++row)
        if (row % 4 / 2 == turn) visit_row(row, {2, 0});
    return velocity_;
  }
  double largest() const { return largest_; }

 private:
  void visit_row(int row, Direction d) {
    for (int column = 0; column < columns_; ++column) visit(row, column, d);
  }

  void visit(int row, int column, Direction d) {
    const int end = column + d.right;
    if (end < 0 || end >= columns_) return;
    const int i = row * columns_ + column, j = (row + d.down) * columns_ + end;
    const auto found = springs_.find(std::minmax(i, j));
    if (found != springs_.end()) visit(found->second, i, j);
  }

  /// From the condition itself: the impulse is -h times the spring's force at the end of the step.
  void visit(const SpringPair& spring, int from, int to) {
    const auto i = static_cast<std::size_t>(from), j = static_cast<std::size_t>(to);
    const double mobility = mobility_[i] + mobility_[j];
    if (mobility == 0) return;
    const Vec3 speed = velocity_[j] - velocity_[i];
    const Vec3 d = position_[j] - position_[i] + step_ * speed;
    const double length = d.norm();
    if (!(length > 0)) return;
    const Vec3 direction = d / length;
    const double rate = direction.dot(speed), stretch = length - spring.rest_length;
    const double impulse = -step_ * (spring.stiffness * stretch + damping_ * rate) /
                           (1 + step_ * (step_ * spring.stiffness + damping_) * mobility);
    velocity_.add(i, -mobility_[i] * impulse * direction);
    velocity_.add(j, mobility_[j] * impulse * direction);
    const double most = std::max(mobility_[i], mobility_[j]) * impulse;
    largest_ = std::max(largest_, most * most);
  }

  int columns_, rows_;
  double damping_, step_;
  const std::vector<double>& mobility_;
  const Vec3Field& position_;
  Vec3Field velocity_;
  std::map<std::pair<int, int>, SpringPair> springs_;
  double largest_ = 0;
};

Scene sheet(int rows, int columns, int families, double damping) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = families & 1 ? 700.0 : 0,
                                 .shear = families & 2 ? 400.0 : 0,
                                 .flexion = families & 4 ? 150.0 : 0,
                                 .damping = damping};
  return scene;
}

/// The largest difference to the reference, relative to the largest change of a velocity.
void compare(const Scene& scene, const std::vector<double>& mobility, Random& random) {
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const auto grid = grid_springs(system);
  ASSERT_TRUE(grid);
  const ClothState state = crumpled_state(system, 0.03, 0.5, random);
  GridSweep sweep(system, *grid, common_mass(system));
  ASSERT_TRUE(sweep.projects());
  constexpr double step = 0.004;
  OneByOne reference(scene, system, step, mobility, state.position, state.velocity);
  const Vec3Field expected = reference.run();
  Vec3Field velocity = state.velocity;
  sweep.begin_projections(mobility);
  const double largest = sweep.project(step, scene.springs->damping, state.position, velocity);
  EXPECT_LE(largest_distance(velocity, expected), 1e-12 * largest_norm(expected))
      << scene.cloth.rows << " x " << scene.cloth.columns;
  EXPECT_GT(largest_distance(expected, state.velocity), 0.01 * largest_norm(expected)) << "nothing moved";
  EXPECT_NEAR(largest, reference.largest(), 1e-11 * reference.largest());
}

std::vector<double> mobilities(std::size_t count, double of_each) {
  return std::vector<double>(count, of_each);
}

TEST_P(ProjectionOfEverySet, VisitsTheSpringsInThePromisedOrder) {
  Random random;
  for (const auto& [rows, columns] : sizes)
    for (const double damping : {0.0, 0.05}) {
      const Scene scene = sheet(rows, columns, 7, damping);
      compare(scene, mobilities(scene.cloth.rows * scene.cloth.columns, 80), random);
    }
}

TEST_P(ProjectionOfEverySet, LeavesOutDirectionsThatHaveNoSprings) {
  Random random;
  for (int families = 1; families < 7; ++families)
    compare(sheet(9, 13, families, 0), mobilities(9 * 13, 80), random);
}

TEST_P(ProjectionOfEverySet, TakesAnyMobilitiesWithPinsAmongThem) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{12, 10}, {7, 33}, {2, 3}})
    for (const double damping : {0.0, 0.05}) {
      std::vector<double> mobility = mobilities(rows * columns, 80);
      for (int row = 0; row < rows; row += 3)  // rows between these are alike
        for (int column = 0; column < columns; column += 2)
          mobility[static_cast<std::size_t>(row * columns + column)] =
              column % 4 == 0 ? 0 : random.uniform(10, 80);
      compare(sheet(rows, columns, 7, damping), mobility, random);
    }
}

TEST_P(ProjectionOfEverySet, LeavesSpringsWithoutLengthAlone) {
  const Scene scene = sheet(4, 9, 1, 0);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  GridSweep sweep(system, *grid_springs(system), common_mass(system));
  Vec3Field position(36), velocity(36);  // all at one place and at rest
  const std::vector<double> mobility = mobilities(36, 80);
  sweep.begin_projections(mobility);
  EXPECT_EQ(sweep.project(0.01, 0.1, position, velocity), 0);
  EXPECT_EQ(largest_norm(velocity), 0);
}

TEST(GridProjection, IsOfEqualSpringsOfFiniteStiffness) {
  Scene scene = sheet(4, 4, 7, 0);
  scene.springs->structural = std::numeric_limits<double>::infinity();
  const ClothSystem rigid = make_grid(scene.cloth, *scene.springs);
  if (const auto grid = grid_springs(rigid)) {
    EXPECT_FALSE(GridSweep(rigid, *grid, 1.0).projects());
  }
}

}  // namespace
}  // namespace cloth::test::grid_projection_test
