// A bounding volume hierarchy: which of many boxes overlap a given one.
//
// Nodes have eight children, whose boxes are stored in single precision and tested at once. Rounding is
// monotonic, so that no overlap is lost; but for visit_eights() hits are tested again in double precision, so
// that the result depends on the boxes and not on the tree. All nodes but those at one edge of the tree are
// full, and its depth is minimal for eight children.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/eight_boxes.h"

namespace cloth {

struct BoxPair {
  int query = 0, index = 0;
  auto operator<=>(const BoxPair&) const = default;
};

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

  /// The boxes in the order of the tree, as the constructor counts them. Eight that lie side by side from a
  /// multiple of eight on are children of one node.
  std::span<const int> order() const { return index_; }

  /// Calls callback(index) for every box that overlaps or touches `query`, in the order of the tree. Does not
  /// allocate.
  template <class Callback>
  void visit(const Bounds& query, Callback&& callback) const {
    visit_from(0, query, [&](int place) { callback(index_[static_cast<std::size_t>(place)]); });
  }

  /// Calls callback(eight, hits) for places 8 `eight` to 8 `eight` + 7 of the order, with a bit for each that
  /// is `first` or a later one and whose box overlaps or touches `query` in single precision: boxes that miss
  /// each other by rounding may be taken for overlapping. Does not allocate.
  template <class Callback>
  void visit_eights(int first, const Bounds& query, Callback&& callback) const;

  /// Appends a pair for every query and each box that it overlaps or touches: by query, and then in the
  /// tree's order, which refit() does not change.
  void collect(std::span<const Bounds> queries, std::vector<BoxPair>& pairs) const;

  /// Appends every pair of boxes of the tree that overlap or touch each other, once: by query, the one that
  /// comes before the other in the tree's order.
  void collect_own(std::vector<BoxPair>& pairs) const;

  /// Levels of nodes: 0 without boxes.
  int depth() const { return depth_; }
  static int depth_of(std::size_t boxes);

  /// Appends the boxes of the nodes `level` below the root and of the leaves above that level, which together
  /// contain every given box, for drawing; from level depth() on, the given boxes. In single precision.
  void append_rounded_boxes(int level, std::vector<Bounds>& boxes) const;

 private:
  static constexpr int width = 8;
  static constexpr int deepest = 11;  // 8^11 > 2^31

  struct Node {
    EightBoxes boxes;
    std::array<int, width> child;  // all nodes, or all boxes: ~place
    std::uint32_t used = 0;        // a bit for each child
  };

  struct Builder;

  /// Calls callback(place) for the boxes whose place is `first` or a later one.
  template <class Callback>
  void visit_from(int first, const Bounds& query, Callback&& callback) const;
  RoundedBox rounded(const Bounds& bounds) const;
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

inline RoundedBox BoxTree::rounded(const Bounds& bounds) const {
  const Eigen::Vector3f lower = (bounds.lower - origin_).cast<float>();
  const Eigen::Vector3f upper = (bounds.upper - origin_).cast<float>();
  return {{lower.x(), lower.y(), lower.z()}, {upper.x(), upper.y(), upper.z()}};
}

template <class Callback>
void BoxTree::visit_eights(int first, const Bounds& query, Callback&& callback) const {
  if (nodes_.empty() || first >= end_[0]) return;
  const RoundedBox rounded_query = rounded(query);
  std::array<int, deepest*(width - 1) + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(waiting[--count])];
    std::uint32_t hits = node.boxes.overlapping(rounded_query) & node.used;
    if (node.child[0] < 0) {
      const int place = ~node.child[0];
      if (first > place) hits &= ~0U << (first - place);
      if (hits != 0) callback(place / width, hits);
      continue;
    }
    for (; hits != 0; hits &= hits - 1) {
      const int child = node.child[static_cast<std::size_t>(std::countr_zero(hits))];
      if (end_[static_cast<std::size_t>(child)] > first) waiting[count++] = child;
    }
  }
}

template <class Callback>
void BoxTree::visit_from(int first, const Bounds& query, Callback&& callback) const {
  visit_eights(first, query, [&](int eight, std::uint32_t hits) {
    for (; hits != 0; hits &= hits - 1) {
      const int place = eight * width + std::countr_zero(hits);
      if (overlap(boxes_[static_cast<std::size_t>(place)], query)) callback(place);
    }
  });
}

}  // namespace cloth
