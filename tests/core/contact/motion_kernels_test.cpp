// What contact asks of all particles, on every instruction set and in shares.
#include "contact/motion_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "contact/particle_motion.h"
#include "kernels/instruction_set.h"
#include "kernels/worker_team.h"
#include "support/random.h"

namespace cloth::test::motion_kernels_test {
namespace {

class ParticleMotion : public testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};

TEST_P(ParticleMotion, HasItsDistancesAndTheLongest) {
  Random random;
  WorkerTeam team(3);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{300}, std::size_t{9001}}) {
    const Vec3Field from = random.field(size, 1), to = random.field(size, 1);
    std::vector<double> alone, shared;
    const double longest = find_distances(from, to, nullptr, alone);
    EXPECT_EQ(find_distances(from, to, &team, shared), longest);
    EXPECT_EQ(shared, alone);
    double expected = 0;
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_NEAR(alone[i], (to[i] - from[i]).norm(), 1e-15 * alone[i]);
      expected = std::max(expected, alone[i]);
    }
    EXPECT_EQ(longest, expected);
  }
}

TEST_P(ParticleMotion, DiffersWhereAnyNumberDoes) {
  Random random;
  const Vec3Field field = random.field(200, 1);
  const auto different = [&](const Vec3Field& other) {
    std::vector<std::size_t> found;
    visit_different(field, other, [&](std::size_t i) { found.push_back(i); });
    return found;
  };
  EXPECT_TRUE(different(field).empty());
  for (const std::size_t i : {std::size_t{0}, std::size_t{63}, std::size_t{64}, std::size_t{199}})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3Field other = field;
      double& number = other.flat()[static_cast<std::size_t>(axis) * field.size() + i];
      number = std::nextafter(number, 2);
      EXPECT_EQ(different(other), std::vector{i}) << "axis " << axis;
    }
}

TEST_P(ParticleMotion, IsFiniteButForInfinityAndWhatIsNoNumber) {
  Random random;
  using Limits = std::numeric_limits<double>;
  for (const std::size_t i : {std::size_t{0}, std::size_t{8}, std::size_t{50}}) {
    Vec3Field field = random.field(17, 1);
    for (const double fine : {Limits::max(), -Limits::max(), Limits::denorm_min(), 0.0}) {
      field.flat()[i] = fine;
      EXPECT_TRUE(are_finite(field)) << fine;
    }
    for (const double wrong : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()}) {
      field.flat()[i] = wrong;
      EXPECT_FALSE(are_finite(field)) << wrong;
    }
  }
}

TEST_P(ParticleMotion, IsWithinWhatIsAllowedOfEach) {
  const MotionKernels& kernels = active_kernels<MotionKernels>();
  constexpr long count = 21;
  const std::vector<double> moved(count, 1), range(count, 0.5), allowed(count, 1.5), beside(count, 2);
  const auto are_within = [&](const std::vector<double>& m, const std::vector<double>& r) {
    return kernels.are_within(m.data(), r.data(), 1, allowed.data(), beside.data(), count);
  };
  EXPECT_TRUE(are_within(moved, range));
  for (const std::size_t i : {std::size_t{0}, std::size_t{15}, std::size_t{20}}) {
    std::vector<double> further = moved, wider = range;
    wider[i] = 0.5 + 1e-15;
    EXPECT_FALSE(are_within(moved, wider));
    further[i] = 1.1, wider[i] = 0.1;  // beyond by what another may move
    EXPECT_FALSE(are_within(further, wider));
  }
}

INSTANTIATE_TEST_SUITE_P(OnEverySet, ParticleMotion, testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& of) { return std::string(name_of(of.param)); });

}  // namespace
}  // namespace cloth::test::motion_kernels_test
