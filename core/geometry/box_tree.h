// A bounding volume hierarchy: which of many boxes overlap a given one.
//
// Nodes have eight children, whose boxes are stored in single precision and tested at once; hits are tested
// again in double precision, so that the result depends on the boxes and not on the tree (BoxTest::exact).
// Rounding is monotonic, so that no overlap is lost. All nodes but those at one edge of the tree are full,
// and its depth is minimal for eight children.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "geometry/bounds.h"

namespace cloth {

struct BoxPair {
  int query = 0, index = 0;
  auto operator<=>(const BoxPair&) const = default;
};

/// Whether hits in single precision are tested again. Without it boxes that miss each other by rounding may
/// be taken for overlapping.
enum class BoxTest { exact, rounded };

class BoxTree {
 public:
  BoxTree() = default;

  /// The same boxes give the same tree. Boxes may be infinite or empty, but not NaN.
  explicit BoxTree(std::span<const Bounds> boxes);

  int size() const { return static_cast<int>(boxes_.size()); }
  /// Around all boxes.
  const Bounds& bounds() const { return bounds_; }

  /// Replaces the boxes by as many others, in their order. Queries stay exact; they become slower where boxes
  /// that were neighbours have moved apart.
  void refit(std::span<const Bounds> boxes);

  /// Calls callback(index) for every box that overlaps or touches `query`, in the order of the tree. Does not
  /// allocate.
  template <BoxTest test = BoxTest::exact, class Callback>
  void visit(const Bounds& query, Callback&& callback) const {
    visit_from<test>(0, query, [&](int place) { callback(index_[static_cast<std::size_t>(place)]); });
  }

  /// Appends a pair for every query and each box that it overlaps or touches: by query, and then in the
  /// tree's order, which refit() does not change.
  void collect(std::span<const Bounds> queries, std::vector<BoxPair>& pairs) const {
    collect<BoxTest::exact>(queries, 0, queries.size(), pairs);
  }
  /// Of the queries [begin, end) only.
  template <BoxTest test>
  void collect(std::span<const Bounds> queries, std::size_t begin, std::size_t end,
               std::vector<BoxPair>& pairs) const;

  /// Appends every pair of boxes of the tree that overlap or touch each other, once: by query, the one that
  /// comes before the other in the tree's order.
  void collect_own(std::vector<BoxPair>& pairs) const {
    collect_own<BoxTest::exact>(0, boxes_.size(), pairs);
  }
  /// Of those whose query has a place in [begin, end) of the tree's order only.
  template <BoxTest test>
  void collect_own(std::size_t begin, std::size_t end, std::vector<BoxPair>& pairs) const;

  /// Levels of nodes: 0 without boxes.
  int depth() const { return depth_; }
  static int depth_of(std::size_t boxes);

  /// Appends the boxes of the nodes `level` below the root and of the leaves above that level, which together
  /// contain every given box, for drawing; from level depth() on, the given boxes. In single precision.
  void append_rounded_boxes(int level, std::vector<Bounds>& boxes) const;

 private:
  static constexpr int width = 8;
  static constexpr int deepest = 11;  // 8^11 > 2^31

  struct alignas(64) Node {
    std::array<std::array<float, width>, 3> lower, upper;
    std::array<int, width> child;  // a node, or ~place of a box
    std::uint32_t used = 0;        // a bit for each child
  };

  struct Query {
    std::array<float, 3> lower, upper;
  };

  struct Builder;

  static std::uint32_t overlapping(const Node& node, const Query& query);
  /// Calls callback(place) for the boxes whose place is `first` or a later one.
  template <BoxTest test, class Callback>
  void visit_from(int first, const Bounds& query, Callback&& callback) const;
  Query rounded(const Bounds& bounds) const;
  void fit();

  // Boxes in the order of the tree; those of a node lie together.
  std::vector<Bounds> boxes_;
  std::vector<int> index_;   // that each was given
  std::vector<Node> nodes_;  // children after their parents
  std::vector<int> end_;     // of each node, the place after that of its last box
  Bounds bounds_;            // of all boxes
  Vec3 origin_{0, 0, 0};     // of single precision
  int depth_ = 0;
};

inline BoxTree::Query BoxTree::rounded(const Bounds& bounds) const {
  const Eigen::Vector3f lower = (bounds.lower - origin_).cast<float>();
  const Eigen::Vector3f upper = (bounds.upper - origin_).cast<float>();
  return {{lower.x(), lower.y(), lower.z()}, {upper.x(), upper.y(), upper.z()}};
}

inline std::uint32_t BoxTree::overlapping(const Node& node, const Query& query) {
#if defined(__SSE2__)
  __m128 low = _mm_castsi128_ps(_mm_set1_epi32(-1)), high = low;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const __m128 from = _mm_set1_ps(query.lower[axis]), to = _mm_set1_ps(query.upper[axis]);
    const float *lower = node.lower[axis].data(), *upper = node.upper[axis].data();
    low = _mm_and_ps(
        low, _mm_and_ps(_mm_cmple_ps(_mm_load_ps(lower), to), _mm_cmple_ps(from, _mm_load_ps(upper))));
    high = _mm_and_ps(high, _mm_and_ps(_mm_cmple_ps(_mm_load_ps(lower + 4), to),
                                       _mm_cmple_ps(from, _mm_load_ps(upper + 4))));
  }
  const int mask = _mm_movemask_ps(low) | _mm_movemask_ps(high) << 4;
  return static_cast<std::uint32_t>(mask) & node.used;
#else
  std::uint32_t mask = 0;
  for (std::size_t k = 0; k < width; ++k) {
    bool hit = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      hit &= node.lower[axis][k] <= query.upper[axis] && query.lower[axis] <= node.upper[axis][k];
    mask |= static_cast<std::uint32_t>(hit) << k;
  }
  return mask & node.used;
#endif
}

template <BoxTest test, class Callback>
void BoxTree::visit_from(int first, const Bounds& query, Callback&& callback) const {
  if (nodes_.empty()) return;
  const Query rounded_query = rounded(query);
  std::array<int, deepest*(width - 1) + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(waiting[--count])];
    for (std::uint32_t hits = overlapping(node, rounded_query); hits != 0; hits &= hits - 1) {
      const int child = node.child[static_cast<std::size_t>(std::countr_zero(hits))];
      if (child >= 0) {
        if (end_[static_cast<std::size_t>(child)] > first) waiting[count++] = child;
        continue;
      }
      const int place = ~child;
      if (place < first) continue;
      if (test == BoxTest::rounded || overlap(boxes_[static_cast<std::size_t>(place)], query))
        callback(place);
    }
  }
}

}  // namespace cloth
