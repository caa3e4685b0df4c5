// Fields that are zero at most particles, and tensions that most springs do not have.
#include "geometry/sparse_field.h"

#include <gtest/gtest.h>

#include "limiter/spring_tensions.h"

namespace cloth::test::sparse_field_test {
namespace {

TEST(SparseField, ListsWhatWasWrittenAndIsZeroElsewhere) {
  SparseField field;
  field.clear(5);
  field.add(3, Vec3(1, 0, 0));
  field.add(1, Vec3(0, 2, 0));
  field.add(3, Vec3(0, 0, 4));
  field.set(1, Vec3(5, 0, 0));
  EXPECT_EQ(std::vector<std::uint32_t>(field.particles().begin(), field.particles().end()),
            (std::vector<std::uint32_t>{3, 1}));
  EXPECT_EQ(field[3], Vec3(1, 0, 4));
  EXPECT_EQ(field[1], Vec3(5, 0, 0));
  for (const std::size_t i : {0, 2, 4}) {
    EXPECT_FALSE(field.has(i));
    EXPECT_EQ(field[i], Vec3(0, 0, 0));
  }
  field.clear(5);
  EXPECT_EQ(field.values(), Vec3Field(5));
  EXPECT_TRUE(field.particles().empty());
  EXPECT_FALSE(field.has(3));
}

TEST(SparseField, CountsEveryParticleOnceItIsWrittenEverywhere) {
  SparseField field;
  field.clear(3);
  field.add(2, Vec3(1, 1, 1));
  field.everywhere().add(0, Vec3(0, 1, 0));
  field.add(1, Vec3(0, 0, 1));
  EXPECT_TRUE(field.is_everywhere());
  EXPECT_TRUE(field.particles().empty());
  EXPECT_TRUE(field.has(0) && field.has(1) && field.has(2));
  Vec3Field sum(3);
  add_scaled(2, field, sum);
  EXPECT_EQ(sum[0], Vec3(0, 2, 0));
  EXPECT_EQ(sum[1], Vec3(0, 0, 2));
  EXPECT_EQ(sum[2], Vec3(2, 2, 2));
  field.clear(3);
  EXPECT_EQ(field.values(), Vec3Field(3));
  EXPECT_FALSE(field.is_everywhere() || field.has(1));
}

TEST(SpringTensions, ListTheSpringsThatHaveOneWhileTheseAreFew) {
  SpringTensions tension(64);
  EXPECT_TRUE(tension.is_few());
  EXPECT_FALSE(tension.any());
  tension.write()[40] = 1, tension.write()[7] = 2;
  std::vector<std::uint32_t> changed{40, 7, 12};
  tension.list_held(changed);
  EXPECT_EQ(std::vector<std::uint32_t>(tension.held().begin(), tension.held().end()),
            (std::vector<std::uint32_t>{7, 40}));
  SpringTensions other(64);
  other.write()[12] = 5;
  other.list_held();
  other.copy(tension);
  EXPECT_EQ(other, tension);
  EXPECT_EQ(other[12], 0);
  other.lower([](std::size_t s) { return s == 7 ? 0.5 : 0.0; });
  EXPECT_EQ(other[7], 0.5);
  EXPECT_EQ(std::vector<std::uint32_t>(other.held().begin(), other.held().end()),
            (std::vector<std::uint32_t>{7}));
  tension.write()[9] = 1;  // a third of 64
  tension.list_held();
  EXPECT_FALSE(tension.is_few());
  EXPECT_TRUE(tension.any());
  other.copy(tension);
  EXPECT_EQ(other, tension);
  EXPECT_FALSE(other.is_few());
  tension.clear();
  EXPECT_EQ(tension.values(), std::vector<double>(64, 0.0));
  EXPECT_TRUE(tension.is_few());
}

}  // namespace
}  // namespace cloth::test::sparse_field_test
