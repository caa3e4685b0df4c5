// XPBD's visits of springs by colours, in every instruction set that this machine has, against springs
// visited one by one in the order that kernels/coloured_springs.h promises.
#include "kernels/coloured_springs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "cloth/grid.h"
#include "geometry/at.h"
#include "kernels/instruction_set.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::coloured_springs_test {
namespace {

class ColoursOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, ColoursOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

ClothSystem grid_of(int rows, int columns) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = 700, .shear = 400, .flexion = 150, .damping = 0};
  return make_grid(scene.cloth, *scene.springs);
}

ClothSystem with_some_springs_missing_and_some_rigid(ClothSystem system) {
  std::vector<SpringRun> runs = system.springs.list();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (r % 5 == 0) runs[r].stiffness = 0;
    if (r % 7 == 3) runs[r].stiffness = std::numeric_limits<double>::infinity();
  }
  system.springs = SpringRuns(runs);
  return system;
}

std::vector<ClothSystem> cloths(Random& random) {
  std::vector<ClothSystem> all;
  for (const auto& [rows, columns] : {std::pair{12, 10}, {17, 23}, {40, 7}})
    all.push_back(irregular_triangulation(rows, columns, 500, true, random));
  all.push_back(grid_of(15, 22));
  all.push_back(shuffled_grid(11, 19, random));
  all.push_back(with_some_springs_missing_and_some_rigid(all.front()));
  return all;
}

/// What moves particles in the visits of one case.
struct Substep {
  double step = 0.004;
  ColouredSprings::Dampers dampers;
  std::vector<double> mobility;
  Vec3Field drag;
  bool has_drag = false;
  Eigen::Matrix3d matrix(std::size_t i) const {
    Eigen::Matrix3d w = mobility[i] * Eigen::Matrix3d::Identity();
    if (has_drag) w -= drag[i] * drag[i].transpose();
    return w;
  }
};

/// The springs visited one after the other, from the condition itself: P = -h f at the end of the step, f the
/// spring's force along its direction.
class OneByOne {
 public:
  OneByOne(const ClothSystem& system, const Substep& substep, const ClothState& state)
      : springs_(springs_of(system)),
        order_(order_by_colours(system).springs),
        substep_(substep),
        position_(state.position),
        velocity_(state.velocity),
        impulse_(springs_.size(), Vec3::Zero()) {}

  void pass() {
    largest_ = 0;
    for (const int spring : order_) visit(springs_[at(spring)], impulse_[at(spring)]);
  }
  const Vec3Field& velocity() const { return velocity_; }
  double largest() const { return largest_; }

 private:
  void visit(const SpringPair& spring, Vec3& impulse) {
    const std::size_t i = at(spring.i), j = at(spring.j);
    const double h = substep_.step, isotropic = substep_.mobility[i] + substep_.mobility[j];
    if (isotropic == 0) return;
    const Eigen::Matrix3d wi = substep_.matrix(i), wj = substep_.matrix(j);
    const Vec3 first = position_[j] - position_[i], speed = velocity_[j] - velocity_[i];
    const Vec3 between = first + h * speed;
    const bool pushes = impulse.dot(between) > 0;
    const Vec3 line = pushes ? between : Vec3(between - h * isotropic * impulse);
    if (!(line.norm() > 0)) return;
    const Vec3 d = line.normalized();
    Vec3 across = Vec3::Zero();
    if (pushes) {
      const double reach = 2 * h * isotropic * impulse.norm();
      across = std::max(0.0, 1 - line.norm() / reach) * (impulse - impulse.dot(d) * d);
    }
    const double give = d.dot((wi + wj) * d), rate = d.dot(speed + (wi + wj) * (across - impulse));
    const double stretch = d.dot(first) + h * rate - spring.rest_length;
    const double k = spring.stiffness, damping = substep_.dampers.each + substep_.dampers.per_stiffness * k;
    const double lambda = std::isinf(k)
                              ? -stretch / (h * give)
                              : -h * (k * stretch + damping * rate) / (1 + h * (h * k + damping) * give);
    const Vec3 next = lambda * d + across, change_i = wi * (next - impulse), change_j = wj * (next - impulse);
    impulse = next;
    velocity_.add(i, -change_i), velocity_.add(j, change_j);
    largest_ = std::max({largest_, change_i.squaredNorm(), change_j.squaredNorm()});
  }

  std::vector<SpringPair> springs_;
  std::vector<int> order_;
  const Substep& substep_;
  const Vec3Field& position_;
  Vec3Field velocity_;
  std::vector<Vec3> impulse_;
  double largest_ = 0;
};

Substep substep_of(const ClothSystem& system, const ColouredSprings::Dampers& dampers, bool has_drag,
                   Random& random) {
  Substep substep{
      .dampers = dampers, .mobility = {}, .drag = Vec3Field(system.mass.size()), .has_drag = has_drag};
  for (std::size_t i = 0; i < system.mass.size(); ++i) {
    const double w = i % 6 == 1 ? 0 : random.uniform(10, 80);
    substep.mobility.push_back(w);
    substep.drag.set(i, std::sqrt(w * random.uniform(0, 0.9)) * random.vector(1).normalized());
  }
  return substep;
}

/// The largest difference to the reference after some passes, relative to the largest velocity.
void compare(const ClothSystem& system, const Substep& substep, int passes, Random& random) {
  const ClothState state = crumpled_state(system, 0.02, 0.5, random);
  ColouredSprings springs(system);
  ASSERT_TRUE(springs.are_visited_by_vectors());
  OneByOne reference(system, substep, state);
  springs.begin(substep.step, substep.dampers, substep.mobility);
  springs.begin_substep(state.position, state.velocity, substep.has_drag ? &substep.drag : nullptr,
                        passes > 1);
  double largest = 0;
  for (int n = 0; n < passes; ++n) reference.pass(), largest = springs.visit(n + 1 == passes);
  Vec3Field velocity(state.velocity.size());
  springs.give(velocity);
  const Vec3Field& expected = reference.velocity();
  EXPECT_LE(largest_distance(velocity, expected), 1e-11 * largest_norm(expected)) << passes;
  EXPECT_GT(largest_distance(expected, state.velocity), 0.01 * largest_norm(expected)) << "nothing moved";
  EXPECT_NEAR(largest, reference.largest(), 1e-9 * reference.largest()) << passes;
}

const std::vector<ColouredSprings::Dampers> all_dampers{{}, {0.05, 0}, {0.02, 1e-4}};

TEST_P(ColoursOfEverySet, AreVisitedInThePromisedOrder) {
  Random random;
  for (const ClothSystem& system : cloths(random))
    for (const auto& dampers : all_dampers)
      for (const bool has_drag : {false, true})
        compare(system, substep_of(system, dampers, has_drag, random), 1, random);
}

TEST_P(ColoursOfEverySet, KeepImpulsesOfEarlierVisitsAndTurnThem) {
  Random random;
  for (const ClothSystem& system : cloths(random))
    for (const auto& dampers : all_dampers)
      for (const bool has_drag : {false, true})
        for (const int passes : {2, 4})
          compare(system, substep_of(system, dampers, has_drag, random), passes, random);
}

TEST_P(ColoursOfEverySet, LeaveSpringsWithoutLengthAlone) {
  const ClothSystem system = grid_of(12, 12);
  const Vec3Field position(system.mass.size()), rest(system.mass.size());  // all at one place and at rest
  ColouredSprings springs(system);
  for (const bool keeps_impulses : {false, true}) {
    springs.begin(0.01, {0.1, 0}, std::vector<double>(system.mass.size(), 80));
    springs.begin_substep(position, rest, nullptr, keeps_impulses);
    for (int n = 0; n < 2; ++n) EXPECT_EQ(springs.visit(true), 0);
    Vec3Field velocity = rest;
    springs.give(velocity);
    EXPECT_EQ(largest_norm(velocity), 0);
  }
}

TEST_P(ColoursOfEverySet, GiveTheSameBitsAgain) {
  Random random;
  const ClothSystem system = irregular_triangulation(17, 23, 500, true, random);
  const Substep substep = substep_of(system, {0.02, 0}, true, random);
  const ClothState state = crumpled_state(system, 0.02, 0.5, random);
  const auto end_of = [&](ColouredSprings& springs) {
    springs.begin(substep.step, substep.dampers, substep.mobility);
    springs.begin_substep(state.position, state.velocity, &substep.drag, true);
    for (int n = 0; n < 3; ++n) springs.visit(false);
    Vec3Field velocity(state.velocity.size());
    springs.give(velocity);
    return velocity;
  };
  ColouredSprings one(system), other(system);
  const Vec3Field first = end_of(one);
  EXPECT_EQ(end_of(one), first);
  EXPECT_EQ(end_of(other), first);
}

TEST(SpringColours, HoldEverySpringOfPositiveStiffnessOnceAndNoParticleTwice) {
  Random random;
  for (const ClothSystem& system : cloths(random)) {
    const std::vector<SpringPair> springs = springs_of(system);
    const SpringOrder order = order_by_colours(system);
    ASSERT_TRUE(order.fills_vectors);
    std::set<int> all;
    for (std::size_t c = 0; c + 1 < order.colour_begin.size(); ++c) {
      std::set<int> particles;
      for (int k = order.colour_begin[c]; k < order.colour_begin[c + 1]; ++k) {
        const int spring = order.springs[at(k)];
        EXPECT_TRUE(all.insert(spring).second) << spring;
        EXPECT_TRUE(particles.insert(springs[at(spring)].i).second) << spring;
        EXPECT_TRUE(particles.insert(springs[at(spring)].j).second) << spring;
        if (k > order.colour_begin[c]) {
          EXPECT_LT(order.springs[at(k) - 1], spring) << "within a colour in the order of springs";
        }
      }
    }
    for (std::size_t s = 0; s < springs.size(); ++s)
      EXPECT_EQ(all.count(static_cast<int>(s)) == 1, springs[s].stiffness > 0) << s;
    EXPECT_EQ(order_by_colours(system).springs, order.springs);
  }
}

// Of a few springs the vectors would be empty for the most part: those are visited one after the other.
TEST(SpringColours, AreNotMadeOfFewSprings) {
  const ClothSystem system = grid_of(3, 3);
  const SpringOrder order = order_by_colours(system);
  EXPECT_FALSE(order.fills_vectors);
  EXPECT_TRUE(order.colour_begin.empty());
  for (std::size_t s = 0; s < order.springs.size(); ++s) EXPECT_EQ(order.springs[s], static_cast<int>(s));
  EXPECT_FALSE(ColouredSprings(system).are_visited_by_vectors());
}

}  // namespace
}  // namespace cloth::test::coloured_springs_test
