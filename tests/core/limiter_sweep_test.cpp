// Sweeps in batches: which springs are done at once, and that it does not matter on what processor.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "cloth/grid.h"
#include "kernels/instruction_set.h"
#include "limiter/deformation_limiter.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::limiter_sweep_test {
namespace {

constexpr double spacing = 0.1;
constexpr double step = 0.001;

Scene limited_sheet(int rows, int columns, std::vector<Pin> pins = {}) {
  Scene scene = bare_sheet(rows, columns, spacing);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
  scene.cloth.pins = std::move(pins);
  scene.deformation = Deformation{};
  scene.deformation->rate = 0.02;
  scene.deformation->solver = "sweeps";
  return scene;
}

std::vector<SpringRun> limited(const ClothSystem& system) {
  std::vector<SpringRun> runs;
  for (const SpringRun& run : system.springs)
    if (run.family != SpringFamily::flexion) runs.push_back(run);
  return runs;
}

/// The same springs as a general mesh has them, in any order and with their ends in any order.
std::vector<SpringRun> one_by_one(const std::vector<SpringRun>& runs, Random& random) {
  std::vector<SpringRun> single;
  for (const SpringRun& run : runs)
    for (int s = 0; s < run.count; ++s) {
      SpringRun spring = run;
      spring.first += s, spring.count = 1;
      if (random.coin()) spring.first += spring.offset, spring.offset = -spring.offset;
      single.push_back(spring);
    }
  for (std::size_t k = single.size(); k > 1; --k)
    std::swap(single[k - 1], single[static_cast<std::size_t>(random.integer(0, static_cast<int>(k) - 1))]);
  return single;
}

using Ends = std::pair<int, int>;

std::multiset<Ends> springs_of(const std::vector<SpringBatch>& batches) {
  std::multiset<Ends> springs;
  for (const SpringBatch& batch : batches) {
    const SpringRow& row = batch.row;
    for (int s = 0; s < row.count; ++s)
      springs.insert({row.first + s * row.stride, row.first + s * row.stride + row.offset});
  }
  return springs;
}

std::multiset<Ends> springs_with_a_free_end(const ClothSystem& system, const std::vector<SpringRun>& runs) {
  std::multiset<Ends> springs;
  for (const SpringRun& run : runs)
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      if (!system.pinned[static_cast<std::size_t>(i)] || !system.pinned[static_cast<std::size_t>(j)])
        springs.insert({std::min(i, j), std::max(i, j)});
    }
  return springs;
}

void expect_independent(const SpringBatch& batch) {
  std::set<int> particles;
  for (int s = 0; s < batch.row.count; ++s) {
    const int i = batch.row.first + s * batch.row.stride;
    EXPECT_TRUE(particles.insert(i).second);
    EXPECT_TRUE(particles.insert(i + batch.row.offset).second);
  }
}

void expect_right_ends(const ClothSystem& system, const SpringBatch& batch) {
  for (int s = 0; s < batch.row.count; ++s) {
    const auto i = static_cast<std::size_t>(batch.row.first + s * batch.row.stride);
    const auto j = i + static_cast<std::size_t>(batch.row.offset);
    EXPECT_EQ(batch.ends == FreeEnds::second, system.pinned[i] != 0);
    EXPECT_EQ(batch.ends == FreeEnds::first, system.pinned[j] != 0);
    for (const std::size_t end : {i, j}) {
      EXPECT_LE(batch.low, static_cast<int>(end) / system.columns);
      EXPECT_GE(batch.high, static_cast<int>(end) / system.columns);
    }
  }
}

void expect_lawful(const ClothSystem& system, const std::vector<SpringRun>& runs) {
  const std::vector<SpringBatch> pieces = pieces_of(system, runs, 0.1);
  const std::vector<SpringBatch> batches = batches_of(pieces, system.columns);
  for (const SpringBatch& piece : pieces) EXPECT_EQ(piece.row.stride, 1);
  for (const SpringBatch& batch : batches) {
    expect_independent(batch);
    expect_right_ends(system, batch);
    EXPECT_DOUBLE_EQ(batch.limit, 1.1 * batch.rest_length);
  }
  EXPECT_EQ(springs_of(pieces), springs_with_a_free_end(system, runs));
  EXPECT_EQ(springs_of(batches), springs_with_a_free_end(system, runs));
}

std::vector<std::vector<Pin>> some_pins() {
  return {{},
          {NamedPin::top_left, NamedPin::top_right},
          {NamedPin::left_edge},
          {NamedPin::top_edge, NamedPin::bottom_edge}};
}

TEST(SweepPlan, HasEverySpringWithAFreeEndInOneBatchAndNoParticleTwiceInABatch) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{2, 2}, {3, 2}, {2, 3}, {5, 4}, {7, 9}, {3, 33}})
    for (const std::vector<Pin>& pins : some_pins()) {
      SCOPED_TRACE(testing::Message() << rows << " x " << columns << ", " << pins.size() << " pins");
      const Scene scene = limited_sheet(rows, columns, pins);
      const ClothSystem system = make_grid(scene.cloth, *scene.springs);
      expect_lawful(system, limited(system));
      expect_lawful(system, system.springs.list());  // flexion springs overlap along a run
      expect_lawful(system, one_by_one(limited(system), random));
    }
}

TEST(SweepPlan, DoesAGridInAtMostFiveBatchesARow) {
  const Scene scene = limited_sheet(6, 9);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  EXPECT_EQ(batches_of(pieces_of(system, limited(system), 0.1), system.columns).size(), 5u * 5 + 2);
}

class SweepsOnEveryInstructionSet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};

DeformationLimiter portable_limiter(const Scene& scene, const ClothSystem& system) {
  set_instruction_set(InstructionSet::portable);
  return {*scene.deformation, system};
}

TEST_P(SweepsOnEveryInstructionSet, LimitToTheSameBits) {
  Random random;
  for (const auto& [rows, columns] : {std::pair{2, 2}, {3, 2}, {4, 5}, {7, 9}, {9, 16}, {6, 17}, {5, 35}})
    for (const std::vector<Pin>& pins : some_pins()) {
      SCOPED_TRACE(testing::Message() << rows << " x " << columns << ", " << pins.size() << " pins");
      const Scene scene = limited_sheet(rows, columns, pins);
      const ClothSystem system = make_grid(scene.cloth, *scene.springs);
      const ClothState start = crumpled_state(system, 0.03, 1, random);
      ClothState plain = start, other = start;
      DeformationLimiter reference = portable_limiter(scene, system);
      set_instruction_set(GetParam());
      DeformationLimiter limiter(*scene.deformation, system);
      EXPECT_EQ(reference.excess(start.position), limiter.excess(start.position));
      const LimiterReport expected = reference.apply(system, step, plain);
      const LimiterReport report = limiter.apply(system, step, other);
      EXPECT_EQ(plain, other);
      EXPECT_EQ(report.sweeps, expected.sweeps);
      EXPECT_EQ(report.excess, expected.excess);
      if (rows > 2) {
        EXPECT_GT(report.sweeps, 1);
      }
    }
}

TEST_P(SweepsOnEveryInstructionSet, IgnoreNumbersThatAreNaN) {
  const Scene scene = limited_sheet(3, 35);
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const DeformationLimiter limiter(*scene.deformation, system);
  for (const int lost : {0, 7, 34, 40}) {
    Vec3Field position = system.start;
    position.add(54, {0, 0, spacing});
    const double alone = limiter.excess(position);
    position.set(static_cast<std::size_t>(lost), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_GT(alone, 0.1);
    EXPECT_EQ(limiter.excess(position), alone);
  }
}

INSTANTIATE_TEST_SUITE_P(OfThisProcessor, SweepsOnEveryInstructionSet,
                         ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

/// Every spring in the given order, once: what a sweep means, without batches and without passing over any.
double plain_sweep(const ClothSystem& system, const std::vector<SpringBatch>& batches, double relaxation,
                   Vec3Field& x) {
  double largest = 0;
  for (const SpringBatch& batch : batches)
    for (int s = 0; s < batch.row.count; ++s) {
      const auto i = static_cast<std::size_t>(batch.row.first + s * batch.row.stride);
      const auto j = i + static_cast<std::size_t>(batch.row.offset);
      const Vec3 d = x[j] - x[i];
      const double length = d.norm();
      if (!(length > batch.limit)) continue;
      const double ends = 2.0 - system.pinned[i] - system.pinned[j];
      const Vec3 shift = relaxation / ends * (1 - batch.limit / length) * d;
      if (!system.pinned[i]) x.add(i, shift);
      if (!system.pinned[j]) x.add(j, -shift);
      largest = std::max(largest, (length - batch.limit) / batch.rest_length);
    }
  return largest;
}

TEST(Sweeps, MoveEverySpringInTheOrderOfTheBatchesPassingOverOnlyWhatIsWithinTheLimit) {
  Random random;
  for (const std::vector<Pin>& pins : some_pins()) {
    Scene scene = limited_sheet(12, 9, pins);
    scene.deformation->max_sweeps = 1;
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    const auto batches = batches_of(pieces_of(system, limited(system), 0.02), system.columns);
    ClothState state = starting_state(system);  // at rest but for one place
    state.position.add(57, random.vector(0.2));
    Vec3Field expected = state.position;
    plain_sweep(system, batches, 1, expected);
    ClothState once = state;
    DeformationLimiter(*scene.deformation, system).apply(system, step, once);
    EXPECT_LE(largest_distance(once.position, expected), 1e-14);

    scene.deformation->max_sweeps = 10;
    DeformationLimiter limiter(*scene.deformation, system);
    for (int n = 1; n < 10; ++n) plain_sweep(system, batches, DeformationLimiter::over_relaxation, expected);
    limiter.apply(system, step, state);
    EXPECT_LE(largest_distance(state.position, expected), 1e-12);
  }
}

TEST(Sweeps, OfAMeshKeepItsLimitAndItsMomentumAndItsPins) {
  Random random;
  for (const bool pinned : {false, true}) {
    Scene scene = limited_sheet(9, 8, pinned ? std::vector<Pin>{NamedPin::top_edge} : std::vector<Pin>{});
    ClothSystem system = make_grid(scene.cloth, *scene.springs);
    system.springs = one_by_one(system.springs.list(), random);
    ClothState state = crumpled_state(system, 0.03, 1, random);
    const ClothState before = state;
    scene.deformation->max_sweeps = 10000;
    const LimiterReport report = DeformationLimiter(*scene.deformation, system).apply(system, step, state);
    EXPECT_GT(report.sweeps, 1);
    EXPECT_LE(report.excess, 1e-4);
    if (!pinned) {
      EXPECT_LE((momentum(system, state) - momentum(system, before)).norm(), 1e-10);
    }
    for (std::size_t i = 0; i < system.pinned.size(); ++i)
      if (system.pinned[i]) {
        EXPECT_EQ(state.position[i], before.position[i]);
        EXPECT_EQ(state.velocity[i], before.velocity[i]);
      }
  }
}

TEST(Sweeps, GiveTheSameBitsForTheSameState) {
  Random random;
  const Scene scene = limited_sheet(12, 12, {NamedPin::top_left});
  const ClothSystem system = make_grid(scene.cloth, *scene.springs);
  const ClothState start = crumpled_state(system, 0.02, 1, random);
  ClothState a = start, b = start, between = crumpled_state(system, 0.03, 1, random);
  DeformationLimiter once(*scene.deformation, system), again(*scene.deformation, system);
  once.apply(system, step, a);
  again.apply(system, step, between);  // nothing of this may be remembered
  again.apply(system, step, b);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace cloth::test::limiter_sweep_test
