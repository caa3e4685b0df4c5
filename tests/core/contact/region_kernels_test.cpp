// The regions of the search for pairs, rounded and coarse: none that overlap are missed, on any instruction
// set.
#include "contact/region_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/coarse_numbers.h"
#include "kernels/instruction_set.h"
#include "support/random.h"

namespace cloth::test::region_kernels_test {
namespace {

/// The hull of some points, grown by a radius: of segments between two of them.
struct Grown {
  std::vector<Vec3> points;
  double radius = 0;

  RoundedRegion region() const {
    RoundedRegion region = rounded(Capsule{points.front(), points.back(), radius});
    for (const Vec3& point : points) {
      const RoundedRegion other = rounded(Capsule{point, points.front(), radius});
      for (std::size_t axis = 0; axis < region_axes; ++axis) {
        region.lower[axis] = std::min(region.lower[axis], other.lower[axis]);
        region.upper[axis] = std::max(region.upper[axis], other.upper[axis]);
      }
    }
    return region;
  }
};

/// A vertex, an edge or a face.
Grown random_grown(const Vec3& around, Random& random) {
  Grown grown;
  const Vec3 middle = around + random.vector(0.3);
  for (int k = random.integer(1, 3); k > 0; --k) grown.points.push_back(middle + random.vector(0.1));
  grown.radius = random.uniform(0, 0.02);
  return grown;
}

Vec3 random_point_of(const Grown& grown, Random& random) {
  Vec3 point = Vec3::Zero();
  double sum = 0;
  for (const Vec3& corner : grown.points) {
    const double weight = random.uniform(0.01, 1);
    point += weight * corner, sum += weight;
  }
  return point / sum;
}

template <class Region>
bool overlap(const Region& a, const Region& b, std::size_t from = 0, std::size_t to = region_axes) {
  for (std::size_t axis = from; axis < to; ++axis)
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  return true;
}

bool boxes_overlap(const RoundedRegion& a, const RoundedRegion& b) {
  return overlap(a, b, 0, 3);
}

bool diagonals_overlap(const RoundedRegion& a, const RoundedRegion& b) {
  return overlap(a, b, 3);
}

class RegionsOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, RegionsOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

struct Many {
  std::vector<CoarseRegion> regions;
  std::vector<EightRegions> eights;
  std::vector<RegionOverlap> overlaps;  ///< some asked of

  Many(std::size_t count, const CoarseNumbers& numbers, Random& random) : eights((count + 7) / 8) {
    for (std::size_t k = 0; k < count; ++k) {
      regions.push_back(numbers.of(random_grown(Vec3::Zero(), random).region()));
      eights[k / 8].set(k % 8, regions.back());
    }
    for (std::size_t eight = 0; eight < eights.size(); ++eight) {
      const std::uint32_t all = count - 8 * eight < 8 ? (1U << (count - 8 * eight)) - 1 : 255;
      const auto hits = static_cast<std::uint32_t>(random.integer(0, 255)) & all;
      overlaps.push_back({7, static_cast<std::uint32_t>(eight), hits});
    }
  }

  std::vector<int> expected(const CoarseRegion& query) const {
    std::vector<int> places;
    for (std::size_t k = 0; k < regions.size(); ++k)
      if ((overlaps[k / 8].hits >> (k % 8) & 1) != 0 && overlap(query, regions[k]))
        places.push_back(static_cast<int>(k));
    return places;
  }

  std::vector<int> find(const CoarseRegion& query) const {
    std::vector<int> places(8 * overlaps.size());
    const int found = active_kernels<RegionKernels>().find(
        eights.data(), overlaps.data(), static_cast<int>(overlaps.size()), query, places.data());
    places.resize(static_cast<std::size_t>(found));
    return places;
  }

  std::vector<int> narrow(const CoarseRegion& query) const {
    std::vector<RegionOverlap> left(overlaps.size());
    const int found = active_kernels<RegionKernels>().narrow(
        eights.data(), overlaps.data(), static_cast<int>(overlaps.size()), query, left.data());
    left.resize(static_cast<std::size_t>(found));
    std::vector<int> places;
    for (const RegionOverlap& overlap : left) {
      EXPECT_EQ(overlap.query, 7);
      EXPECT_NE(overlap.hits, 0u);
      for (int k = 0; k < 8; ++k)
        if ((overlap.hits >> k & 1) != 0) places.push_back(static_cast<int>(8 * overlap.eight) + k);
    }
    return places;
  }
};

TEST_P(RegionsOfEverySet, FindsThoseAskedOfWhoseEndsOverlap) {
  Random random;
  std::size_t all = 0, asked = 0;
  const CoarseNumbers numbers(Vec3::Zero(), 0.5);
  for (const std::size_t count : {1u, 8u, 13u, 700u}) {
    const Many many(count, numbers, random);
    for (int trial = 0; trial < 400; ++trial) {
      const CoarseRegion query = numbers.of(random_grown(Vec3::Zero(), random).region());
      const std::vector<int> expected = many.expected(query);
      ASSERT_EQ(many.find(query), expected);
      ASSERT_EQ(many.narrow(query), expected);
      all += expected.size(), asked += count;
    }
  }
  EXPECT_GT(all, 500u);
  EXPECT_LT(all, asked / 2) << "nothing is told apart";
}

/// Of regions that touch along an axis, and miss each other by one number.
TEST_P(RegionsOfEverySet, TellsApartWhatMissesByOneNumberAlongOneAxis) {
  CoarseRegion query;
  for (std::size_t axis = 0; axis < region_axes; ++axis)
    query.lower[axis] = -32767, query.upper[axis] = 32767;
  const RegionOverlap all{0, 0, 255};
  for (std::size_t axis = 0; axis < region_axes; ++axis) {
    for (const int from : {-32767, -5, 0, 77, 32766}) {
      CoarseRegion one = query;
      one.upper[axis] = static_cast<std::int16_t>(from);
      EightRegions eights;
      for (std::size_t k = 0; k < 8; ++k) {
        CoarseRegion other = query;
        other.lower[axis] = static_cast<std::int16_t>(k % 2 == 0 ? from : from + 1);
        eights.set(k, other);
      }
      RegionOverlap left{};
      ASSERT_EQ(active_kernels<RegionKernels>().narrow(&eights, &all, 1, one, &left), 1);
      EXPECT_EQ(left.hits, 0x55u) << axis << ", " << from;
      for (std::size_t k = 0; k < 8; ++k) {
        CoarseRegion other = query;
        other.upper[axis] = static_cast<std::int16_t>(k % 2 == 0 ? from + 1 : from);
        eights.set(k, other);
      }
      one = query;
      one.lower[axis] = static_cast<std::int16_t>(from + 1);
      ASSERT_EQ(active_kernels<RegionKernels>().narrow(&eights, &all, 1, one, &left), 1);
      EXPECT_EQ(left.hits, 0x55u) << axis << ", " << from;
    }
  }
}

/// At any distance from the middle, and however small or large the unit is.
TEST(CoarseNumbers, KeepTheOrderOfWhatTheyStandFor) {
  Random random;
  for (const double unit : {1e-30, 1e-3, 1.0, 1e6}) {
    const Vec3 middle = random.vector(3);
    const CoarseNumbers numbers(middle, unit);
    int told_apart = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      const double far = unit * std::pow(10, random.uniform(-4, 4));
      const RoundedRegion a = rounded(Capsule{middle + random.vector(far), middle + random.vector(far), 0});
      const RoundedRegion b = rounded(Capsule{middle + random.vector(far), middle + random.vector(far), 0});
      const CoarseRegion coarse = numbers.of(a), other = numbers.of(b);
      for (std::size_t axis = 0; axis < region_axes; ++axis) {
        ASSERT_LE(coarse.lower[axis], coarse.upper[axis]);
        if (a.lower[axis] <= b.upper[axis]) {
          ASSERT_LE(coarse.lower[axis], other.upper[axis]) << unit << ", " << far;
        }
      }
      told_apart += overlap(coarse, other) ? 0 : 1;
    }
    if (unit > 1e-6) {  // or rounding to single precision leaves nothing of it
      EXPECT_GT(told_apart, 1000) << unit;
    }
  }
}

TEST(CoarseNumbers, Have4096StepsToAUnitNearTheMiddleAndAThousandthFurtherOut) {
  const CoarseNumbers numbers({1, 2, 3}, 0.5);
  const auto number = [&](double x) {
    return numbers.of(rounded(Capsule{{x, 2, 3}, {x, 2, 3}, 0})).lower[0];
  };
  EXPECT_EQ(number(1), 0);
  EXPECT_NEAR(number(1.25), 2048, 1);
  EXPECT_NEAR(number(0.75), -2048, 1);
  for (const double units : {2.0, 7.0, 40.0, 200.0}) {
    EXPECT_LT(number(1 + 0.5 * units), number(1 + 0.5 * units * 1.002)) << units;
    EXPECT_GT(number(1 - 0.5 * units), number(1 - 0.5 * units * 1.002)) << units;
  }
  EXPECT_EQ(number(1e4), number(1e30));
}

/// Far from the origin single precision has millimetres, or centimetres.
TEST(Regions, OverlapWhereWhatTheyBoundDoes) {
  Random random;
  for (const double far : {0.0, 1e3, 1e5}) {
    int told_apart = 0;
    for (int trial = 0; trial < 3000; ++trial) {
      const Vec3 around = Vec3::Constant(far);
      const Grown one = random_grown(around, random);
      Grown other = random_grown(around, random);
      const RoundedRegion before = one.region(), elsewhere = other.region();
      told_apart += overlap(before, elsewhere) ? 0 : 1;
      const Vec3 apart = random.vector(1).normalized() * 0.999 * (one.radius + other.radius);
      const Vec3 shift = random_point_of(one, random) + apart - random_point_of(other, random);
      for (Vec3& point : other.points) point += shift;
      ASSERT_TRUE(overlap(one.region(), other.region())) << far << ", trial " << trial;
    }
    EXPECT_GT(told_apart, 1000) << far;
  }
}

TEST(Regions, OfABoxHasItsCornersAndNothingBeyond) {
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    const Bounds box = bounds_of(random.vector(1), random.vector(1));
    const RoundedRegion region = rounded(box);
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 at = box.lower;
      for (int axis = 0; axis < 3; ++axis)
        if ((corner >> axis & 1) != 0) at[axis] = box.upper[axis];
      const RoundedRegion point = rounded(Capsule{at, at, 1e-6});
      ASSERT_TRUE(overlap(region, point));
      const Vec3 beyond = at + 1e-3 * (at - 0.5 * (box.lower + box.upper)).cwiseSign();
      const RoundedRegion outside = rounded(Capsule{beyond, beyond, 1e-6});
      ASSERT_FALSE(boxes_overlap(region, outside));
      ASSERT_FALSE(diagonals_overlap(region, outside));  // each corner is the end of a diagonal
    }
  }
}

}  // namespace
}  // namespace cloth::test::region_kernels_test
