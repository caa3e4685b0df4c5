// The rounded regions of the search for pairs: none that overlap are missed, on any instruction set.
#include "contact/region_kernels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/regions.h"
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
    for (const Vec3& point : points) region.add(rounded(Capsule{point, points.front(), radius}));
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

template <std::size_t axes>
bool overlap(const RoundedExtents<axes>& a, const RoundedExtents<axes>& b) {
  for (std::size_t axis = 0; axis < axes; ++axis)
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  return true;
}

class RegionsOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, RegionsOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

struct Many {
  std::vector<RoundedRegion> regions;
  std::vector<EightRegions> eights;
  std::vector<RegionOverlap> overlaps;  ///< some asked of

  explicit Many(std::size_t count, const Vec3& around, Random& random) : eights((count + 7) / 8) {
    for (std::size_t k = 0; k < count; ++k) {
      regions.push_back(random_grown(around, random).region());
      eights[k / 8].set(k % 8, regions.back());
    }
    for (std::size_t eight = 0; eight < eights.size(); ++eight) {
      const std::uint32_t all = count - 8 * eight < 8 ? (1U << (count - 8 * eight)) - 1 : 255;
      const auto hits = static_cast<std::uint32_t>(random.integer(0, 255)) & all;
      overlaps.push_back({7, static_cast<std::uint32_t>(eight), hits});
    }
  }

  std::vector<int> find(const RoundedRegion& query) const {
    std::vector<int> places(8 * overlaps.size());
    const int found = active_kernels<RegionKernels>().find(
        eights.data(), overlaps.data(), static_cast<int>(overlaps.size()), query, places.data());
    places.resize(static_cast<std::size_t>(found));
    return places;
  }
};

TEST_P(RegionsOfEverySet, FindsThoseAskedOfWhoseExtentsOverlap) {
  Random random;
  std::size_t boxes = 0, all = 0;
  for (const std::size_t count : {1u, 8u, 13u, 700u}) {
    const Many many(count, Vec3::Zero(), random);
    for (int trial = 0; trial < 400; ++trial) {
      const RoundedRegion query = random_grown(Vec3::Zero(), random).region();
      std::vector<int> expected;
      for (std::size_t k = 0; k < count; ++k) {
        if ((many.overlaps[k / 8].hits >> (k % 8) & 1) == 0) continue;
        const RoundedRegion& region = many.regions[k];
        boxes += overlap(query.box, region.box) ? 1 : 0;
        if (overlap(query.box, region.box) && overlap(query.diagonals, region.diagonals))
          expected.push_back(static_cast<int>(k));
      }
      all += expected.size();
      ASSERT_EQ(many.find(query), expected);
    }
  }
  EXPECT_GT(all, 500u);
  EXPECT_LT(all, 0.9 * static_cast<double>(boxes)) << "the diagonals tell nothing";
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
      told_apart +=
          overlap(before.box, elsewhere.box) && overlap(before.diagonals, elsewhere.diagonals) ? 0 : 1;
      const Vec3 apart = random.vector(1).normalized() * 0.999 * (one.radius + other.radius);
      const Vec3 shift = random_point_of(one, random) + apart - random_point_of(other, random);
      for (Vec3& point : other.points) point += shift;
      const RoundedRegion a = one.region(), b = other.region();
      ASSERT_TRUE(overlap(a.box, b.box) && overlap(a.diagonals, b.diagonals)) << far << ", trial " << trial;
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
      ASSERT_TRUE(overlap(region.box, point.box) && overlap(region.diagonals, point.diagonals));
      const Vec3 beyond = at + 1e-3 * (at - 0.5 * (box.lower + box.upper)).cwiseSign();
      const RoundedRegion outside = rounded(Capsule{beyond, beyond, 1e-6});
      ASSERT_FALSE(overlap(region.box, outside.box));
      ASSERT_FALSE(overlap(region.diagonals, outside.diagonals));  // each corner is the end of a diagonal
    }
  }
}

}  // namespace
}  // namespace cloth::test::region_kernels_test
