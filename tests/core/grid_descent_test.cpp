// VBD's visits of particles by the kernels, of a grid and of any cloth of springs, in every instruction set
// that this machine has, against particles visited one by one in the order that kernels/grid_visits.h and
// cloth/particle_elements.h promise.
#include "kernels/grid_descent.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/particle_elements.h"
#include "geometry/at.h"
#include "kernels/grid_layout.h"
#include "kernels/instruction_set.h"
#include "kernels/mesh_descent.h"
#include "support/meshes.h"
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

using Colours = std::vector<std::vector<int>>;

Colours colours_of_grid(const ClothSystem& system) {
  Colours colours(5);
  for (int row = 0; row < system.rows; ++row)
    for (int column = 0; column < system.columns; ++column)
      colours[at((row + 2 * column) % 5)].push_back(system.index(row, column));
  return colours;
}

/// N s/m of every spring, and s, a damping time of its stiffness.
struct Dampers {
  double each = 0, time = 0;
};

/// G(x) = sum m/(2 h^2) |x - y|^2 + sum over springs of k/2 (l - L)^2, and along each a damper, minimised
/// particle by particle from index pairs.
class OneByOne {
 public:
  OneByOne(const ClothSystem& system, Colours colours, const Dampers& dampers, double step,
           const std::vector<double>& mass, const Vec3Field& start, const Vec3Field& predicted)
      : colours_(std::move(colours)),
        dampers_(dampers),
        step_(step),
        mass_(mass),
        start_(start),
        inertial_(start),
        drag_(start.size()) {
    for (std::size_t i = 0; i < start.size(); ++i) inertial_.add(i, step * predicted[i]);
    position_ = inertial_, before_ = inertial_;
    springs_.resize(start.size());
    for (const SpringPair& spring : springs_of(system))
      for (const int end : {spring.i, spring.j}) springs_[static_cast<std::size_t>(end)].push_back(spring);
  }

  void sweep() {
    present_ = position_;
    largest_ = squares_ = 0;
    for (const std::vector<int>& colour : colours_)
      for (const int particle : colour) visit(at(particle));
  }
  void extrapolate(double weight) {
    for (std::size_t i = 0; i < position_.size(); ++i)
      position_.set(i, weight * (position_[i] - before_[i]) + before_[i]);
    before_ = present_;
  }

  /// From here on W^-1 = m I + b b^T about these velocities.
  void set_drag(const Vec3Field& drag, const Vec3Field& predicted) {
    drag_ = drag;
    for (std::size_t i = 0; i < start_.size(); ++i) inertial_.set(i, start_[i] + step_ * predicted[i]);
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
    const Eigen::Matrix3d dragged = drag_[i] * drag_[i].transpose() / (step_ * step_);
    Vec3 force = -inertia * beyond - dragged * beyond;
    Eigen::Matrix3d slope = inertia * Eigen::Matrix3d::Identity() + dragged;
    double reach = beyond.norm();
    for (const SpringPair& spring : springs_[i]) {
      const auto j = static_cast<std::size_t>(static_cast<std::size_t>(spring.i) == i ? spring.j : spring.i);
      const Vec3 d = position_[j] - position_[i];
      const double damping = dampers_.each + dampers_.time * spring.stiffness;
      const double length = d.norm(), along = spring.stiffness + damping / step_;
      reach = std::max(reach, length + spring.rest_length);
      if (length == 0) {
        slope += along * Eigen::Matrix3d::Identity();
        continue;
      }
      const Vec3 n = d / length;
      const double rate = n.dot(d - (start_[j] - start_[i])) / step_;
      const double tension = spring.stiffness * (length - spring.rest_length) + damping * rate;
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

  Colours colours_;
  Dampers dampers_;
  double step_;
  const std::vector<double>& mass_;
  const Vec3Field& start_;
  Vec3Field inertial_, drag_, position_, before_, present_;
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
  bool has_drag = false;
};

/// Three sweeps with two extrapolations between them, each sweep's outcome relative to the largest move; with
/// drag another one before each. Returns how many visits a reach has ended.
int compare(const ClothSystem& system, ParticleDescent& descent, const Colours& colours,
            const Dampers& dampers, const std::vector<double>& mass, Random& random, const Case& of) {
  ClothState state = crumpled_state(system, of.crumple, of.speed, random);
  for (double& x : state.position.flat()) x *= of.size;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] == 0) state.velocity.set(i, Vec3::Zero());
  OneByOne reference(system, colours, dampers, of.step, mass, state.position, state.velocity);
  descent.begin({.step = of.step,
                 .mass = mass,
                 .spring_damping = dampers.each,
                 .stretch_time = dampers.time,
                 .position = state.position,
                 .predicted = state.velocity,
                 .extrapolates = true,
                 .has_drag = of.has_drag});
  const double h = of.step;
  for (const double weight : {1.0, 1.4, 1.2}) {
    if (of.has_drag) {
      const Vec3Field drag = random.field(mass.size(), 0.1);
      Vec3Field predicted = state.velocity;
      for (std::size_t i = 0; i < mass.size(); ++i)
        if (mass[i] > 0) predicted.add(i, random.vector(0.1));
      descent.set_drag(drag, predicted), reference.set_drag(drag, predicted);
      state.velocity = predicted;
    }
    reference.sweep();
    const ParticleDescent::Sums sums = descent.sweep();
    Vec3Field velocity(state.velocity.size());
    descent.end(velocity);
    const Vec3Field moved = reference.moved();
    const std::string where = std::to_string(system.rows) + " x " + std::to_string(system.columns);
    Vec3Field scaled(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
      scaled.set(i, moved[i] / h);
      velocity.add(i, -state.velocity[i]);
    }
    EXPECT_LE(largest_distance(velocity, scaled), of.tolerance * largest_norm(scaled)) << where;
    EXPECT_GT(largest_norm(moved), 1e-4) << "nothing moved";
    EXPECT_NEAR(sums.change * h * h, reference.largest(), 10 * of.tolerance * reference.largest()) << where;
    EXPECT_NEAR(sums.squares * h * h, reference.squares(), 10 * of.tolerance * reference.squares()) << where;
    descent.extrapolate(weight), reference.extrapolate(weight);
  }
  return reference.shortened;
}

int compare(const Scene& scene, const std::vector<double>& mass, Random& random, const Case& of = {}) {
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const auto grid = grid_springs(system);
  EXPECT_TRUE(grid && GridDescent::suits(*grid));
  GridDescent descent(*grid);
  return compare(system, descent, colours_of_grid(system), {scene.springs->damping, 0}, mass, random, of);
}

int compare_on_mesh(const ClothSystem& system, const Dampers& dampers, const std::vector<double>& mass,
                    Random& random, const Case& of = {}) {
  ParticleElements elements(system);
  elements.list();
  EXPECT_TRUE(MeshDescent::suits(system.springs));
  MeshDescent descent(system, elements);
  return compare(system, descent, elements.colours(), dampers, mass, random, of);
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

TEST_P(DescentOfEverySet, TakesDragAnewBeforeEverySweep) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{12, 10}, {7, 33}})
    for (const double damping : {0.0, 0.05}) {
      std::vector<double> mass = masses(rows * columns);
      for (std::size_t i = 0; i < mass.size(); i += 7) mass[i] = 0;
      const Case windy{.has_drag = true};
      compare(sheet(rows, columns, 7, damping), mass, random, windy);
      compare_on_mesh(irregular_triangulation(rows, columns, 500, true, random), {damping, 0}, mass, random,
                      windy);
    }
}

TEST_P(DescentOfEverySet, VisitsTheParticlesOfAMeshByTheirColours) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{3, 4}, {12, 10}, {17, 23}, {40, 7}})
    for (const Dampers& dampers : {Dampers{}, {0.05, 0}, {0, 1e-4}}) {
      std::vector<double> mass = masses(rows * columns);
      for (std::size_t i = 0; i < mass.size(); i += 3) mass[i] = i % 2 == 0 ? 0 : random.uniform(0.01, 0.1);
      compare_on_mesh(irregular_triangulation(rows, columns, 500, true, random), dampers, mass, random);
      compare_on_mesh(shuffled_grid(rows, columns, random), dampers, masses(rows * columns), random);
    }
}

TEST_P(DescentOfEverySet, GoesNoFurtherThanAnElementReachesWhereTheClothIsCrushed) {
  Random random;
  const Case crushed{.step = 1, .crumple = 1e-3, .speed = 0, .size = 0.5, .tolerance = 1e-6};
  EXPECT_GT(compare(sheet(14, 23, 7, 0), masses(14 * 23), random, crushed), 0);
  EXPECT_GT(compare_on_mesh(shuffled_grid(14, 23, random), {}, masses(14 * 23), random, crushed), 0);
}

std::unique_ptr<ParticleDescent> on_grid(const ClothSystem& system) {
  return std::make_unique<GridDescent>(*grid_springs(system));
}
std::unique_ptr<ParticleDescent> on_mesh(const ClothSystem& system) {
  ParticleElements elements(system);
  elements.list();
  return std::make_unique<MeshDescent>(system, elements);
}

TEST_P(DescentOfEverySet, LeavesSpringsWithoutLengthAlone) {
  const Scene scene = sheet(4, 9, 1, 0.1);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const Vec3Field position(36), rest(36);  // all at one place and at rest
  const std::vector<double> mass = masses(36);
  for (const auto& descent : {on_grid(system), on_mesh(system)}) {
    descent->begin(
        {.step = 0.01, .mass = mass, .spring_damping = 0.1, .position = position, .predicted = rest});
    EXPECT_EQ(descent->sweep().change, 0);
    Vec3Field velocity(36);
    descent->end(velocity);
    EXPECT_EQ(largest_norm(velocity), 0);
  }
}

TEST_P(DescentOfEverySet, GivesTheSameBitsAgain) {
  Random random;
  const Scene scene = sheet(17, 26, 7, 0.02);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const ClothState state = crumpled_state(system, 0.03, 0.5, random);
  const std::vector<double> mass = masses(17 * 26);
  const auto end_of = [&](ParticleDescent& descent) {
    descent.begin({.step = 0.004,
                   .mass = mass,
                   .spring_damping = 0.02,
                   .position = state.position,
                   .predicted = state.velocity,
                   .extrapolates = true});
    for (int k = 0; k < 5; ++k) descent.sweep(), descent.extrapolate(k == 0 ? 1 : 1.3);
    Vec3Field velocity(state.velocity.size());
    descent.end(velocity);
    return velocity;
  };
  for (const auto& make : {on_grid, on_mesh}) {
    const auto one = make(system), other = make(system);
    const Vec3Field first = end_of(*one);
    EXPECT_EQ(end_of(*one), first);
    EXPECT_EQ(end_of(*other), first);
  }
}

// The colours of a grid are the same in both storages, so that they visit in one order.
TEST_P(DescentOfEverySet, GivesAGridTheSameVisitsFromSlots) {
  Random random;
  compare_on_mesh(make_grid(sheet(12, 17, 7, 0).cloth, *sheet(12, 17, 7, 0).springs), {0.02, 0},
                  masses(12 * 17), random);
}

TEST(GridDescent, IsOfSpringsOfFiniteStiffness) {
  Scene scene = sheet(4, 4, 7, 0);
  scene.springs->structural = std::numeric_limits<double>::infinity();
  const ClothSystem rigid = make_grid(scene.cloth, *scene.springs);
  if (const auto grid = grid_springs(rigid)) {
    EXPECT_FALSE(GridDescent::suits(*grid));
  }
  EXPECT_FALSE(MeshDescent::suits(rigid.springs));
}

}  // namespace
}  // namespace cloth::test::grid_descent_test
