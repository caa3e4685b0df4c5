// VBD's visits of a grid's particles by the kernels, in every instruction set that this machine has, against
// particles visited one by one in the order that kernels/grid_visits.h promises.
#include "kernels/grid_descent.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "cloth/grid.h"
#include "kernels/grid_layout.h"
#include "kernels/instruction_set.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::grid_descent_test {
namespace {

class DescentOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, DescentOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

constexpr std::pair<int, int> sizes[] = {{2, 2},   {2, 3},   {3, 2},  {3, 17},  {7, 9},  {33, 33}, {40, 7},
                                         {12, 10}, {65, 64}, {2, 70}, {11, 41}, {20, 6}, {5, 45},  {6, 82}};

/// G(x) = sum m/(2 h^2) |x - y|^2 + sum over springs of k/2 (l - L)^2, and along each a damper, minimised
/// particle by particle from index pairs.
class OneByOne {
 public:
  OneByOne(const ClothSystem& system, double damping, double step, const std::vector<double>& mass,
           const Vec3Field& start, const Vec3Field& predicted)
      : system_(system), damping_(damping), step_(step), mass_(mass), start_(start), inertial_(start) {
    for (std::size_t i = 0; i < start.size(); ++i) inertial_.add(i, step * predicted[i]);
    position_ = inertial_, before_ = inertial_;
    springs_.resize(start.size());
    for (const SpringPair& spring : springs_of(system))
      for (const int end : {spring.i, spring.j}) springs_[static_cast<std::size_t>(end)].push_back(spring);
  }

  void sweep() {
    present_ = position_;
    largest_ = squares_ = 0;
    for (int colour = 0; colour < 5; ++colour)
      for (int row = 0; row < system_.rows; ++row)
        for (int column = 0; column < system_.columns; ++column)
          if ((row + 2 * column) % 5 == colour) visit(static_cast<std::size_t>(system_.index(row, column)));
  }
  void extrapolate(double weight) {
    for (std::size_t i = 0; i < position_.size(); ++i)
      position_.set(i, weight * (position_[i] - before_[i]) + before_[i]);
    before_ = present_;
  }

  /// m, what the particles have moved from where inertia takes them.
  Vec3Field moved() const {
    Vec3Field result = position_;
    for (std::size_t i = 0; i < result.size(); ++i) result.add(i, -inertial_[i]);
    return result;
  }
  double largest() const { return largest_; }
  double squares() const { return squares_; }
  int shortened = 0;  ///< visits that a reach has ended

 private:
  void visit(std::size_t i) {
    if (mass_[i] == 0) return;
    const double inertia = mass_[i] / (step_ * step_);
    const Vec3 beyond = position_[i] - inertial_[i];
    Vec3 force = -inertia * beyond;
    Eigen::Matrix3d slope = inertia * Eigen::Matrix3d::Identity();
    double reach = beyond.norm();
    for (const SpringPair& spring : springs_[i]) {
      const auto j = static_cast<std::size_t>(static_cast<std::size_t>(spring.i) == i ? spring.j : spring.i);
      const Vec3 d = position_[j] - position_[i];
      const double length = d.norm(), along = spring.stiffness + damping_ / step_;
      reach = std::max(reach, length + spring.rest_length);
      if (length == 0) {
        slope += along * Eigen::Matrix3d::Identity();
        continue;
      }
      const Vec3 n = d / length;
      const double rate = n.dot(d - (start_[j] - start_[i])) / step_;
      const double tension = spring.stiffness * (length - spring.rest_length) + damping_ * rate;
      force += tension * n;
      const Eigen::Matrix3d line = n * n.transpose();
      slope += along * line + std::max(tension / length, 0.0) * (Eigen::Matrix3d::Identity() - line);
    }
    Vec3 change = slope.llt().solve(force);
    if (change.norm() > reach) change *= reach / change.norm(), ++shortened;
    position_.add(i, change);
    largest_ = std::max(largest_, change.squaredNorm());
    squares_ += change.squaredNorm();
  }

  const ClothSystem& system_;
  double damping_, step_;
  const std::vector<double>& mass_;
  const Vec3Field& start_;
  Vec3Field inertial_, position_, before_, present_;
  std::vector<std::vector<SpringPair>> springs_;
  double largest_ = 0, squares_ = 0;
};

Scene sheet(int rows, int columns, int families, double damping) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = families & 1 ? 700.0 : 0,
                                 .shear = families & 2 ? 400.0 : 0,
                                 .flexion = families & 4 ? 150.0 : 0,
                                 .damping = damping};
  return scene;
}

std::vector<double> masses(int count, double of_each = 0.01) {
  return std::vector<double>(static_cast<std::size_t>(count), of_each);
}

struct Case {
  double step = 0.004;
  double crumple = 0.03;  ///< m
  double speed = 0.5;     ///< m/s
  double size = 1;        ///< of the sheet, in parts of what it is at rest
  double tolerance = 1e-11;
};

/// Three sweeps with two extrapolations between them, each sweep's outcome relative to the largest move.
/// Returns how many visits a reach has ended.
int compare(const Scene& scene, const std::vector<double>& mass, Random& random, const Case& of = {}) {
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const auto grid = grid_springs(system);
  EXPECT_TRUE(grid && GridDescent::suits(*grid));
  ClothState state = crumpled_state(system, of.crumple, of.speed, random);
  for (double& x : state.position.flat()) x *= of.size;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] == 0) state.velocity.set(i, Vec3::Zero());
  GridDescent descent(*grid);
  OneByOne reference(system, scene.springs->damping, of.step, mass, state.position, state.velocity);
  descent.begin(of.step, mass, scene.springs->damping, state.position, state.velocity, true);
  const double h = of.step;
  for (const double weight : {1.0, 1.4, 1.2}) {
    reference.sweep();
    const GridDescent::Sums sums = descent.sweep();
    Vec3Field velocity(state.velocity.size());
    descent.end(velocity);
    const Vec3Field moved = reference.moved();
    const std::string where = std::to_string(scene.cloth.rows) + " x " + std::to_string(scene.cloth.columns);
    Vec3Field scaled(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) scaled.set(i, moved[i] / h);
    EXPECT_LE(largest_distance(velocity, scaled), of.tolerance * largest_norm(scaled)) << where;
    EXPECT_GT(largest_norm(moved), 1e-4) << "nothing moved";
    EXPECT_NEAR(sums.change * h * h, reference.largest(), 10 * of.tolerance * reference.largest()) << where;
    EXPECT_NEAR(sums.squares * h * h, reference.squares(), 10 * of.tolerance * reference.squares()) << where;
    descent.extrapolate(weight), reference.extrapolate(weight);
  }
  return reference.shortened;
}

TEST_P(DescentOfEverySet, VisitsTheParticlesInThePromisedOrder) {
  Random random;
  for (const auto& [rows, columns] : sizes)
    for (const double damping : {0.0, 0.05})
      EXPECT_EQ(compare(sheet(rows, columns, 7, damping), masses(rows * columns), random), 0);
}

TEST_P(DescentOfEverySet, LeavesOutDirectionsThatHaveNoSprings) {
  Random random;
  for (int families = 1; families < 7; ++families) compare(sheet(9, 13, families, 0), masses(9 * 13), random);
}

TEST_P(DescentOfEverySet, TakesAnyMassesWithPinsAmongThem) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{12, 10}, {7, 33}, {2, 3}})
    for (const double damping : {0.0, 0.05}) {
      std::vector<double> mass = masses(rows * columns);
      for (std::size_t i = 0; i < mass.size(); i += 3) mass[i] = i % 2 == 0 ? 0 : random.uniform(0.01, 0.1);
      compare(sheet(rows, columns, 7, damping), mass, random);
    }
}

TEST_P(DescentOfEverySet, GoesNoFurtherThanAnElementReachesWhereTheClothIsCrushed) {
  Random random;
  const Scene scene = sheet(14, 23, 7, 0);
  const int shortened = compare(scene, masses(14 * 23), random,
                                {.step = 1, .crumple = 1e-3, .speed = 0, .size = 0.5, .tolerance = 1e-6});
  EXPECT_GT(shortened, 0);
}

TEST_P(DescentOfEverySet, LeavesSpringsWithoutLengthAlone) {
  const Scene scene = sheet(4, 9, 1, 0.1);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  GridDescent descent(*grid_springs(system));
  const Vec3Field position(36), rest(36);  // all at one place and at rest
  descent.begin(0.01, masses(36), 0.1, position, rest, false);
  EXPECT_EQ(descent.sweep().change, 0);
  Vec3Field velocity(36);
  descent.end(velocity);
  EXPECT_EQ(largest_norm(velocity), 0);
}

TEST_P(DescentOfEverySet, GivesTheSameBitsAgain) {
  Random random;
  const Scene scene = sheet(17, 26, 7, 0.02);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const ClothState state = crumpled_state(system, 0.03, 0.5, random);
  const auto end_of = [&](GridDescent& descent) {
    descent.begin(0.004, masses(17 * 26), 0.02, state.position, state.velocity, true);
    for (int k = 0; k < 5; ++k) descent.sweep(), descent.extrapolate(k == 0 ? 1 : 1.3);
    Vec3Field velocity(state.velocity.size());
    descent.end(velocity);
    return velocity;
  };
  GridDescent one(*grid_springs(system)), other(*grid_springs(system));
  const Vec3Field first = end_of(one);
  EXPECT_EQ(end_of(one), first);
  EXPECT_EQ(end_of(other), first);
}

TEST(GridDescent, IsOfSpringsOfFiniteStiffness) {
  Scene scene = sheet(4, 4, 7, 0);
  scene.springs->structural = std::numeric_limits<double>::infinity();
  const ClothSystem rigid = make_grid(scene.cloth, *scene.springs);
  if (const auto grid = grid_springs(rigid)) {
    EXPECT_FALSE(GridDescent::suits(*grid));
  }
}

}  // namespace
}  // namespace cloth::test::grid_descent_test
