// The hierarchy of boxes against the loop over all of them.
#include "geometry/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.h"

namespace cloth::test::box_tree_test {
namespace {

using Boxes = std::vector<Bounds>;

std::vector<BoxPair> all_pairs(const Boxes& queries, const Boxes& boxes) {
  std::vector<BoxPair> pairs;
  for (std::size_t q = 0; q < queries.size(); ++q)
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (overlap(queries[q], boxes[i])) pairs.push_back({static_cast<int>(q), static_cast<int>(i)});
  return pairs;
}

std::vector<BoxPair> in_tree_order(const Boxes& queries, const BoxTree& tree) {
  std::vector<BoxPair> pairs;
  tree.collect(queries, pairs);
  return pairs;
}

std::vector<BoxPair> tree_pairs(const Boxes& queries, const BoxTree& tree) {
  std::vector<BoxPair> pairs = in_tree_order(queries, tree);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void expect_as_brute_force(const Boxes& queries, const Boxes& boxes, const BoxTree& tree) {
  EXPECT_EQ(tree_pairs(queries, tree), all_pairs(queries, boxes)) << boxes.size() << " boxes";
}

/// Boxes of triangles of all sizes, in a cloud or along a line.
Boxes random_boxes(int count, double size, Random& random) {
  const bool line = random.integer(0, 3) == 0;
  Boxes boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 place = line ? Vec3(random.uniform(-1, 1), 0, 0) : random.vector(1);
    const double scale = size * std::pow(10, random.uniform(-2, 0));
    boxes.push_back(
        bounds_of(Vec3(place + random.vector(scale)), Vec3(place + random.vector(scale)), Vec3(place)));
  }
  return boxes;
}

void shift(Boxes& boxes, const Vec3& by) {
  for (Bounds& box : boxes) box = {box.lower + by, box.upper + by};
}

Boxes drawn_boxes(const BoxTree& tree, int level) {
  Boxes boxes;
  tree.append_rounded_boxes(level, boxes);
  return boxes;
}

TEST(Bounds, WithoutPointsOverlapNothing) {
  const Bounds everywhere{Vec3::Constant(-Bounds::infinity), Vec3::Constant(Bounds::infinity)};
  EXPECT_FALSE(overlap(Bounds(), bounds_of(Vec3(0, 0, 0))));
  EXPECT_TRUE(overlap(everywhere, bounds_of(Vec3(0, 0, 0))));
}

TEST(Bounds, ThatTouchOverlapAndThatMissByOneUlpDoNot) {
  const Bounds unit = bounds_of(Vec3(0, 0, 0), Vec3(1, 1, 1));
  const Vec3 corner(1, 1, 1), beyond(std::nextafter(1, 2), 1, 1), top(2, 2, 2);
  EXPECT_TRUE(overlap(unit, bounds_of(corner, top)));
  EXPECT_FALSE(overlap(unit, bounds_of(beyond, top)));
  const BoxTree tree(Boxes{unit});
  EXPECT_EQ(tree_pairs({bounds_of(corner, top), bounds_of(beyond, top)}, tree),
            (std::vector<BoxPair>{{0, 0}}));
}

TEST(Bounds, OfSeveralPartsOverlapWhereNoSideIsInAllTheirOutcodes) {
  Random random;
  int inside = 0;
  for (int round = 0; round < 20'000; ++round) {
    const auto any_box = [&] {
      Bounds box;
      for (int axis = 0; axis < 3; ++axis) {  // of few different numbers, so that some touch
        const int low = random.integer(-3, 3);
        box.lower[axis] = low, box.upper[axis] = low + random.integer(0, 3);
      }
      return box;
    };
    const Bounds box = any_box(), a = any_box(), b = any_box(), c = any_box();
    const bool expected = overlap(bounds_of(a, b, c), box);
    EXPECT_EQ((outcode(a, box) & outcode(b, box) & outcode(c, box)) == 0, expected);
    EXPECT_EQ(outcode(a, box) == 0, overlap(a, box));
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 2000);
  EXPECT_LT(inside, 18'000);
}

TEST(BoxTree, FindsWhatTheLoopOverAllBoxesFinds) {
  Random random;
  for (const int count : {0, 1, 2, 7, 8, 9, 10, 63, 64, 65, 100, 511, 512, 513, 1500}) {
    for (const double size : {1e-3, 0.1, 1.0}) {
      const Boxes boxes = random_boxes(count, size, random), queries = random_boxes(200, 0.1, random);
      const BoxTree tree(boxes);
      EXPECT_EQ(tree.size(), count);
      expect_as_brute_force(queries, boxes, tree);
      expect_as_brute_force(boxes, boxes, tree);
      ASSERT_FALSE(HasFailure());
    }
  }
}

TEST(BoxTree, FindsTouchingBoxesOfARaster) {
  Boxes cells;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      cells.push_back(bounds_of(Vec3(0.1 * i, 0.1 * j, 0), Vec3(0.1 * (i + 1), 0.1 * (j + 1), 0)));
  const BoxTree tree(cells);
  expect_as_brute_force(cells, cells, tree);
  EXPECT_EQ(tree_pairs(cells, tree).size(), 58U * 58U);
}

TEST(BoxTree, TakesEqualBoxesPointsAndTheWholeOfSpace) {
  const Bounds everywhere{Vec3::Constant(-Bounds::infinity), Vec3::Constant(Bounds::infinity)};
  for (const int count : {1, 5, 8, 100, 1000}) {
    const Boxes same(static_cast<std::size_t>(count), bounds_of(Vec3(1, 2, 3)));
    const BoxTree tree(same);
    const auto pairs =
        tree_pairs({bounds_of(Vec3(1, 2, 3)), bounds_of(Vec3(1, 2, 3.1)), everywhere, Bounds()}, tree);
    ASSERT_EQ(pairs.size(), 2 * same.size());
    EXPECT_EQ(pairs.back(), (BoxPair{2, count - 1}));
  }
}

TEST(BoxTree, HoldsEmptyAndInfiniteBoxesAmongOthers) {
  Random random;
  Boxes boxes = random_boxes(300, 0.1, random);
  for (std::size_t i = 0; i < boxes.size(); i += 40) boxes[i] = Bounds();
  const Boxes queries = random_boxes(100, 0.3, random);
  expect_as_brute_force(queries, boxes, BoxTree(boxes));
  for (std::size_t i = 20; i < boxes.size(); i += 40)
    boxes[i].upper = Vec3::Constant(Bounds::infinity), boxes[i].lower.y() = -Bounds::infinity;
  expect_as_brute_force(queries, boxes, BoxTree(boxes));
  expect_as_brute_force(boxes, boxes, BoxTree(boxes));
}

TEST(BoxTree, WithoutBoxesFindsNothing) {
  for (const BoxTree& tree : {BoxTree(), BoxTree(Boxes())}) {
    EXPECT_EQ(tree.size(), 0);
    EXPECT_EQ(tree.depth(), 0);
    EXPECT_TRUE(tree_pairs({bounds_of(Vec3(0, 0, 0))}, tree).empty());
    EXPECT_TRUE(drawn_boxes(tree, 0).empty());
  }
}

TEST(BoxTree, IsExactFarFromTheOriginAndForTheVerySmall) {
  Random random;
  for (const double far : {1e3, 1e6, 1e12}) {
    Boxes boxes = random_boxes(300, 0.1, random), queries = random_boxes(100, 0.1, random);
    const Vec3 by = far * Vec3(1, -0.7, 0.3);
    shift(boxes, by), shift(queries, by);
    expect_as_brute_force(queries, boxes, BoxTree(boxes));
  }
  Boxes mixed = random_boxes(300, 1e-9, random);
  for (Bounds& box : mixed) box = {1e-9 * box.lower, 1e-9 * box.upper};
  mixed.push_back(bounds_of(Vec3(-1e9, -1, -1), Vec3(1e9, 1, 1)));
  expect_as_brute_force(mixed, mixed, BoxTree(mixed));
}

TEST(BoxTree, StaysExactAfterAnyMotion) {
  Random random;
  for (const int count : {1, 8, 9, 700}) {
    Boxes boxes = random_boxes(count, 0.1, random);
    BoxTree tree(boxes);
    for (const double motion : {0.01, 1.0, 100.0}) {
      for (Bounds& box : boxes) {
        const Vec3 by = random.vector(motion);
        box = {box.lower + by, box.upper + by};
      }
      shift(boxes, {motion, 0, -motion});
      tree.refit(boxes);
      expect_as_brute_force(boxes, boxes, tree);
      expect_as_brute_force(random_boxes(200, 0.5, random), boxes, tree);
    }
  }
}

TEST(BoxTree, FindsItsOwnPairsOnce) {
  Random random;
  for (const int count : {0, 1, 2, 8, 9, 65, 700}) {
    const Boxes boxes = random_boxes(count, 0.3, random);
    std::vector<BoxPair> own, expected = all_pairs(boxes, boxes);
    std::erase_if(expected, [](const BoxPair& pair) { return pair.query >= pair.index; });
    BoxTree(boxes).collect_own(own);
    for (BoxPair& pair : own)
      if (pair.query > pair.index) std::swap(pair.query, pair.index);
    std::sort(own.begin(), own.end());
    EXPECT_EQ(own, expected);
  }
}

/// Every box that visit_eights() finds, by its place in the tree's order.
std::vector<int> places_of_eights(const BoxTree& tree, int first, const Bounds& query) {
  std::vector<int> places;
  tree.visit_eights(first, query, [&](int eight, std::uint32_t hits) {
    EXPECT_NE(hits, 0u);
    for (int k = 0; k < 32; ++k)
      if ((hits >> k & 1) != 0) places.push_back(8 * eight + k);
  });
  std::sort(places.begin(), places.end());
  return places;
}

TEST(BoxTree, FindsEightsFromAPlaceOn) {
  Random random;
  for (const int count : {1, 7, 8, 9, 63, 700}) {
    const Boxes boxes = random_boxes(static_cast<std::size_t>(count), 0.3, random);
    const BoxTree tree(boxes);
    ASSERT_EQ(tree.order().size(), boxes.size());
    const Bounds everywhere = bounds_of(Vec3(-9, -9, -9), Vec3(9, 9, 9));
    for (const int first : {0, 1, 6, 8, count / 2, count - 1, count}) {
      std::vector<int> later;
      for (int place = first; place < count; ++place) later.push_back(place);
      EXPECT_EQ(places_of_eights(tree, first, everywhere), later) << first << " of " << count;
    }
  }
}

/// Far from the origin single precision has millimetres.
TEST(BoxTree, MissesNoneByRoundingAndTakesFewMore) {
  Random random;
  Boxes boxes = random_boxes(700, 0.3, random);
  for (Bounds& box : boxes) box = {box.lower + Vec3(3e4, 0, 0), box.upper + Vec3(3e4, 0, 0)};
  boxes.push_back(bounds_of(Vec3(-3e4, 0, 0)));
  const BoxTree tree(boxes);
  std::vector<BoxPair> exact, rounded;
  tree.collect(boxes, exact);
  for (int q = 0; q < static_cast<int>(boxes.size()); ++q)
    for (const int place : places_of_eights(tree, 0, boxes[static_cast<std::size_t>(q)]))
      rounded.push_back({q, tree.order()[static_cast<std::size_t>(place)]});
  for (auto* pairs : {&exact, &rounded}) std::sort(pairs->begin(), pairs->end());
  EXPECT_TRUE(std::includes(rounded.begin(), rounded.end(), exact.begin(), exact.end()));
  EXPECT_GT(rounded.size(), exact.size()) << "nothing was rounded";
  EXPECT_LT(rounded.size(), 1.1 * exact.size());
}

TEST(BoxTree, VisitsWhatItCollects) {
  Random random;
  const Boxes boxes = random_boxes(700, 0.3, random);
  const BoxTree tree(boxes);
  std::vector<BoxPair> visited;
  for (int q = 0; q < 700; ++q)
    tree.visit(boxes[static_cast<std::size_t>(q)], [&](int index) { visited.push_back({q, index}); });
  std::sort(visited.begin(), visited.end());
  EXPECT_EQ(visited, all_pairs(boxes, boxes));
}

TEST(BoxTree, CollectsForQueriesThatLieSideBySide) {
  Random random;
  const Boxes boxes = random_boxes(700, 0.1, random);
  Boxes row;
  for (int i = 0; i < 203; ++i) row.push_back(bounds_of(Vec3(0.02 * i - 2, 0, 0)).grown(0.3));
  row[77] = Bounds();
  expect_as_brute_force(row, boxes, BoxTree(boxes));
}

TEST(BoxTree, AppendsToWhatIsThereByQuery) {
  Random random;
  const Boxes boxes = random_boxes(200, 0.3, random);
  const BoxTree tree(boxes);
  std::vector<BoxPair> pairs{{9, 9}};
  tree.collect(boxes, pairs);
  EXPECT_EQ(pairs.front(), (BoxPair{9, 9}));
  EXPECT_TRUE(std::is_sorted(pairs.begin() + 1, pairs.end(),
                             [](const BoxPair& a, const BoxPair& b) { return a.query < b.query; }));
}

TEST(BoxTree, CollectsInAnOrderThatRefittingDoesNotChange) {
  Random random;
  BoxTree tree(random_boxes(300, 0.3, random));
  const Boxes everywhere(300, bounds_of(Vec3(0, 0, 0)).grown(9));
  tree.refit(everywhere);
  std::vector<BoxPair> order = in_tree_order({everywhere[0]}, tree);
  ASSERT_EQ(order.size(), 300u);
  for (int trial = 0; trial < 20; ++trial) {
    tree.refit(random_boxes(300, 0.5, random));
    auto next = order.begin();
    for (const BoxPair& pair : in_tree_order(random_boxes(1, 0.5, random), tree)) {
      next = std::find(next, order.end(), pair);
      ASSERT_NE(next, order.end());
    }
  }
}

TEST(BoxTree, IsAsFlatAsEightChildrenAllow) {
  Random random;
  EXPECT_EQ(BoxTree(random_boxes(1, 0.1, random)).depth(), 1);
  EXPECT_EQ(BoxTree(random_boxes(8, 0.1, random)).depth(), 1);
  EXPECT_EQ(BoxTree(random_boxes(9, 0.1, random)).depth(), 2);
  EXPECT_EQ(BoxTree(random_boxes(512, 0.1, random)).depth(), 3);
  EXPECT_EQ(BoxTree(random_boxes(513, 0.1, random)).depth(), 4);
}

constexpr double single_precision = 1e-6;  // of coordinates of about 1

TEST(BoxTree, HasOneBoxAtTheTopAndTheGivenOnesAtTheBottom) {
  Random random;
  const Boxes boxes = random_boxes(512, 0.1, random);
  const BoxTree tree(boxes);
  const Boxes top = drawn_boxes(tree, 0);
  ASSERT_EQ(top.size(), 1U);
  Bounds all;
  for (const Bounds& box : boxes) all.add(box);
  EXPECT_LE((top[0].lower - all.lower).norm(), single_precision);
  EXPECT_LE((top[0].upper - all.upper).norm(), single_precision);
  EXPECT_EQ(drawn_boxes(tree, 1).size(), 8U);
  EXPECT_EQ(drawn_boxes(tree, 2).size(), 64U);
  EXPECT_EQ(drawn_boxes(tree, 3).size(), 512U);
  for (const Bounds& box : drawn_boxes(tree, 2)) EXPECT_TRUE(overlap(box, all));
}

}  // namespace
}  // namespace cloth::test::box_tree_test
