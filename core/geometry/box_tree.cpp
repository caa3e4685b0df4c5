#include "geometry/box_tree.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace cloth {
namespace {

/// Half the surface, which an overlapping box meets in proportion to its area (Goldsmith and Salmon 1987).
double half_surface(const Bounds& bounds) {
  const Vec3 side = (bounds.upper - bounds.lower).cwiseMax(0);
  return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
}

struct Cut {
  double cost = Bounds::infinity;
  int axis = 0;
  std::ptrdiff_t left = 0;  // boxes before the cut
};

/// Boxes sorted into equal intervals of their middles along one axis.
class Bins {
 public:
  static constexpr int count = 16;

  Bins(int axis, double lower, double upper) : axis_(axis), lower_(lower), scale_(count / (upper - lower)) {}

  void add(const Bounds& bounds, double middle) {
    const auto k = static_cast<std::size_t>(std::clamp((middle - lower_) * scale_, 0.0, count - 1.0));
    bounds_[k].add(bounds);
    ++boxes_[k];
  }

  /// The boundary between bins with the least sum of surface times boxes on both sides.
  Cut best() const {
    std::array<double, count> right_cost{};
    Bounds right;
    std::ptrdiff_t boxes = 0;
    for (std::size_t k = count - 1; k > 0; --k) {
      right.add(bounds_[k]);
      boxes += boxes_[k];
      right_cost[k] = half_surface(right) * static_cast<double>(boxes);
    }
    Cut cut;
    Bounds left;
    boxes = 0;
    for (std::size_t k = 0; k + 1 < count; ++k) {
      left.add(bounds_[k]);
      boxes += boxes_[k];
      const double cost = half_surface(left) * static_cast<double>(boxes) + right_cost[k + 1];
      if (cost < cut.cost) cut = {cost, axis_, boxes};
    }
    return cut;
  }

 private:
  int axis_;
  double lower_, scale_;
  std::array<Bounds, count> bounds_;
  std::array<std::ptrdiff_t, count> boxes_{};
};

}  // namespace

struct BoxTree::Builder {
  using Range = std::span<int>;

  BoxTree& tree;
  std::vector<Vec3> middle;

  int add_node(Range range, int level) {
    tree.depth_ = std::max(tree.depth_, level + 1);
    const std::size_t number = tree.nodes_.size();
    tree.nodes_.emplace_back();
    // As much as a child can hold, so that all are full but the last.
    std::size_t capacity = 1;
    while (capacity * width < range.size()) capacity *= width;
    std::array<Range, width> parts;
    std::size_t used = 0;
    divide(range, capacity, parts, used);
    for (std::size_t k = 0; k < used; ++k) {
      const int child = capacity == 1 ? ~parts[k].front() : add_node(parts[k], level + 1);
      tree.nodes_[number].child[k] = child;  // after the call: nodes move as their number grows
    }
    tree.nodes_[number].used = (1U << used) - 1;
    return static_cast<int>(number);
  }

  void divide(Range range, std::size_t capacity, std::array<Range, width>& parts, std::size_t& used) {
    if (range.size() <= capacity) {
      parts[used++] = range;
      return;
    }
    const Cut cut = best_cut(range);
    const std::size_t children = (range.size() + capacity - 1) / capacity;
    const std::size_t wished = (static_cast<std::size_t>(cut.left) + capacity / 2) / capacity;
    const std::size_t left = std::clamp<std::size_t>(wished, 1, children - 1) * capacity;
    const auto before = [&](int i, int j) {
      const double at = middle[static_cast<std::size_t>(i)][cut.axis];
      const double other = middle[static_cast<std::size_t>(j)][cut.axis];
      return at < other || (at == other && i < j);
    };
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(left), range.end(), before);
    divide(range.first(left), capacity, parts, used);
    divide(range.subspan(left), capacity, parts, used);
  }

  Cut best_cut(Range range) const {
    Bounds middles;
    for (const int i : range) middles.add(middle[static_cast<std::size_t>(i)]);
    Cut best;
    best.left = static_cast<std::ptrdiff_t>(range.size() / 2);
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = middles.upper[axis] - middles.lower[axis];
      if (!(extent > 0 && extent < Bounds::infinity)) continue;
      Bins bins(axis, middles.lower[axis], middles.upper[axis]);
      for (const int i : range)
        bins.add(tree.boxes_[static_cast<std::size_t>(i)], middle[static_cast<std::size_t>(i)][axis]);
      const Cut cut = bins.best();
      if (cut.cost < best.cost) best = cut;
    }
    return best;
  }
};

BoxTree::BoxTree(std::span<const Bounds> boxes) : boxes_(boxes.begin(), boxes.end()) {
  if (boxes.empty()) return;
  Builder builder{*this, {}};
  builder.middle.reserve(boxes.size());
  for (const Bounds& box : boxes) builder.middle.emplace_back(0.5 * box.lower + 0.5 * box.upper);
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(boxes.size() / (width - 2) + 2);
  builder.add_node(order, 0);
  fit();
}

void BoxTree::refit(std::span<const Bounds> boxes) {
  assert(boxes.size() == boxes_.size());
  std::copy(boxes.begin(), boxes.end(), boxes_.begin());
  fit();
}

void BoxTree::fit() {
  Bounds all;
  for (const Bounds& box : boxes_) all.add(box);
  if (!nodes_.empty()) origin_ = 0.5 * all.lower + 0.5 * all.upper;
  for (std::size_t number = nodes_.size(); number-- > 0;) {
    Node& node = nodes_[number];
    const auto used = static_cast<std::size_t>(std::popcount(node.used));
    for (std::size_t k = 0; k < used; ++k) {
      const int child = node.child[k];
      if (child < 0) {
        const Query leaf = rounded(boxes_[static_cast<std::size_t>(~child)]);
        for (std::size_t axis = 0; axis < 3; ++axis)
          node.lower[axis][k] = leaf.lower[axis], node.upper[axis][k] = leaf.upper[axis];
        continue;
      }
      const Node& below = nodes_[static_cast<std::size_t>(child)];
      const auto filled = std::popcount(below.used);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto &lower = below.lower[axis], &upper = below.upper[axis];
        node.lower[axis][k] = *std::min_element(lower.begin(), lower.begin() + filled);
        node.upper[axis][k] = *std::max_element(upper.begin(), upper.begin() + filled);
      }
    }
  }
}

void BoxTree::collect(std::span<const Bounds> queries, std::vector<BoxPair>& pairs) const {
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const auto first = static_cast<std::ptrdiff_t>(pairs.size());
    visit(queries[q], [&](int index) { pairs.push_back({static_cast<int>(q), index}); });
    std::sort(pairs.begin() + first, pairs.end());
  }
}

std::vector<Bounds> BoxTree::boxes_at(int level) const {
  std::vector<Bounds> below(nodes_.size());
  std::vector<int> level_of(nodes_.size(), 0);
  for (std::size_t number = 0; number < nodes_.size(); ++number)
    for (int k = 0; k < std::popcount(nodes_[number].used); ++k)
      if (const int child = nodes_[number].child[static_cast<std::size_t>(k)]; child >= 0)
        level_of[static_cast<std::size_t>(child)] = level_of[number] + 1;
  std::vector<Bounds> found;
  for (std::size_t number = nodes_.size(); number-- > 0;) {
    for (int k = 0; k < std::popcount(nodes_[number].used); ++k) {
      const int child = nodes_[number].child[static_cast<std::size_t>(k)];
      const Bounds& part = child >= 0 ? below[static_cast<std::size_t>(child)] : box(~child);
      below[number].add(part);
      if (child < 0 && level_of[number] + 1 == level) found.push_back(part);
    }
    if (level_of[number] == level) found.push_back(below[number]);
  }
  return found;
}

}  // namespace cloth
