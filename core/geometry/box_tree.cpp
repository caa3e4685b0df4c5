#include "geometry/box_tree.h"

#include <algorithm>
#include <cassert>

namespace cloth {
namespace {

/// Half the surface, which an overlapping box meets in proportion to its area (Goldsmith and Salmon 1987).
double half_surface(const Bounds& bounds) {
  const Vec3 side = (bounds.upper - bounds.lower).cwiseMax(0);
  return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
}

/// Of an empty or an infinite box, which has none, the origin.
Vec3 middle_of(const Bounds& bounds) {
  const Vec3 middle = 0.5 * bounds.lower + 0.5 * bounds.upper;
  return middle.allFinite() ? middle : Vec3(0, 0, 0);
}

struct Cut {
  double cost = Bounds::infinity;
  int axis = 0;
  std::ptrdiff_t left = 0;  // boxes before the cut
};

struct Item {
  Bounds bounds;
  Vec3 middle;
  int index;
};

/// Boxes sorted into equal intervals of their middles along each axis.
class Bins {
 public:
  explicit Bins(std::span<const Item> items) {
    Bounds middles;
    for (const Item& item : items) middles.add(item.middle);
    const Vec3 extent = middles.upper - middles.lower;
    lower_ = middles.lower;
    for (int axis = 0; axis < 3; ++axis)
      scale_[axis] = extent[axis] > 0 && extent[axis] < Bounds::infinity ? count / extent[axis] : 0;
    for (const Item& item : items) {
      const Vec3 at = (item.middle - lower_).cwiseProduct(scale_);
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin =
            bins_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(std::clamp(at[axis], 0.0, last))];
        bin.bounds.add(item.bounds);
        ++bin.boxes;
      }
    }
  }

  /// The boundary between bins with the least sum of surface times boxes on both sides; in the middle where
  /// all boxes have the same.
  Cut best(std::ptrdiff_t boxes) const {
    Cut best;
    best.left = boxes / 2;
    for (int axis = 0; axis < 3; ++axis) {
      if (scale_[axis] == 0) continue;
      const Cut cut = best_along(axis);
      if (cut.cost < best.cost) best = cut;
    }
    return best;
  }

 private:
  static constexpr std::size_t count = 16;
  static constexpr double last = count - 1;

  struct Bin {
    Bounds bounds;
    std::ptrdiff_t boxes = 0;
    void add(const Bin& other) {
      bounds.add(other.bounds);
      boxes += other.boxes;
    }
    double cost() const { return half_surface(bounds) * static_cast<double>(boxes); }
  };

  Cut best_along(int axis) const {
    const auto& bins = bins_[static_cast<std::size_t>(axis)];
    std::array<double, count> right_cost{};
    Bin left, right;
    for (std::size_t k = count - 1; k > 0; --k) {
      right.add(bins[k]);
      right_cost[k] = right.cost();
    }
    Cut cut;
    for (std::size_t k = 0; k + 1 < count; ++k) {
      left.add(bins[k]);
      const double cost = left.cost() + right_cost[k + 1];
      if (cost < cut.cost) cut = {cost, axis, left.boxes};
    }
    return cut;
  }

  Vec3 lower_{0, 0, 0}, scale_{0, 0, 0};
  std::array<std::array<Bin, count>, 3> bins_;
};

}  // namespace

struct BoxTree::Builder {
  using Range = std::span<Item>;

  BoxTree& tree;
  std::vector<Item> items;

  int add_node(Range range, int level) {
    tree.depth_ = std::max(tree.depth_, level + 1);
    const std::size_t number = tree.nodes_.size();
    tree.nodes_.emplace_back();
    tree.end_.push_back(static_cast<int>(range.data() - items.data()) + static_cast<int>(range.size()));
    // As much as a child can hold, so that all are full but the last.
    std::size_t capacity = 1;
    while (capacity * width < range.size()) capacity *= width;
    assert(capacity > 1 || static_cast<std::size_t>(range.data() - items.data()) % width == 0);
    std::array<Range, width> parts;
    std::size_t used = 0;
    if (capacity == 1)
      for (std::size_t k = 0; k < range.size(); ++k) parts[used++] = range.subspan(k, 1);
    else
      divide(range, capacity, parts, used);
    for (std::size_t k = 0; k < used; ++k) {
      const int place = static_cast<int>(parts[k].data() - items.data());
      const int child = capacity == 1 ? ~place : add_node(parts[k], level + 1);
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
    const Cut cut = Bins(range).best(static_cast<std::ptrdiff_t>(range.size()));
    const std::size_t children = (range.size() + capacity - 1) / capacity;
    const std::size_t wished = (static_cast<std::size_t>(cut.left) + capacity / 2) / capacity;
    const std::size_t left = std::clamp<std::size_t>(wished, 1, children - 1) * capacity;
    const auto before = [axis = cut.axis](const Item& a, const Item& b) {
      return a.middle[axis] < b.middle[axis] || (a.middle[axis] == b.middle[axis] && a.index < b.index);
    };
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(left), range.end(), before);
    divide(range.first(left), capacity, parts, used);
    divide(range.subspan(left), capacity, parts, used);
  }
};

BoxTree::BoxTree(std::span<const Bounds> boxes) : boxes_(boxes.size()) {
  if (boxes.empty()) return;
  Builder builder{*this, {}};
  builder.items.reserve(boxes.size());
  for (const Bounds& box : boxes)
    builder.items.push_back({box, middle_of(box), static_cast<int>(builder.items.size())});
  nodes_.reserve(boxes.size() / (width - 2) + 2);
  builder.add_node(builder.items, 0);
  index_.reserve(boxes.size());
  for (const Item& item : builder.items) index_.push_back(item.index);
  refit(boxes);
}

int BoxTree::depth_of(std::size_t boxes) {
  if (boxes == 0) return 0;
  int depth = 1;
  for (std::size_t room = width; room < boxes; room *= width) ++depth;
  return depth;
}

void BoxTree::refit(std::span<const Bounds> boxes) {
  assert(boxes.size() == boxes_.size());
  for (std::size_t place = 0; place < boxes_.size(); ++place)
    boxes_[place] = boxes[static_cast<std::size_t>(index_[place])];
  fit();
}

void BoxTree::fit() {
  bounds_ = {};
  for (const Bounds& box : boxes_) bounds_.add(box);
  origin_ = middle_of(bounds_);
  for (std::size_t number = nodes_.size(); number-- > 0;) {
    Node& node = nodes_[number];
    const auto used = static_cast<std::size_t>(std::popcount(node.used));
    for (std::size_t k = 0; k < used; ++k) {
      const int child = node.child[k];
      if (child < 0) {
        node.boxes.set(k, rounded(boxes_[static_cast<std::size_t>(~child)]));
        continue;
      }
      const Node& below = nodes_[static_cast<std::size_t>(child)];
      const auto filled = std::popcount(below.used);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float *const lower = below.boxes.lower[axis], *const upper = below.boxes.upper[axis];
        node.boxes.lower[axis][k] = *std::min_element(lower, lower + filled);
        node.boxes.upper[axis][k] = *std::max_element(upper, upper + filled);
      }
    }
  }
}

void BoxTree::collect(std::span<const Bounds> queries, std::vector<BoxPair>& pairs) const {
  for (std::size_t q = 0; q < queries.size(); ++q)
    visit(queries[q], [&, query = static_cast<int>(q)](int index) { pairs.push_back({query, index}); });
}

void BoxTree::collect_own(std::vector<BoxPair>& pairs) const {
  for (std::size_t place = 0; place < boxes_.size(); ++place)
    visit_from(static_cast<int>(place) + 1, boxes_[place], [&, query = index_[place]](int other) {
      pairs.push_back({query, index_[static_cast<std::size_t>(other)]});
    });
}

void BoxTree::append_rounded_boxes(int level, std::vector<Bounds>& boxes) const {
  struct Place {
    int node, level;
  };
  if (nodes_.empty()) return;
  std::array<Place, deepest*(width - 1) + 1> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0};
  if (level <= 0) boxes.emplace_back();
  while (count > 0) {
    const Place here = waiting[--count];
    const Node& node = nodes_[static_cast<std::size_t>(here.node)];
    for (std::size_t k = 0; k < static_cast<std::size_t>(std::popcount(node.used)); ++k) {
      if (node.child[k] >= 0 && here.level + 1 < level) {
        waiting[count++] = {node.child[k], here.level + 1};
        continue;
      }
      Bounds box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        box.lower[a] = origin_[a] + static_cast<double>(node.boxes.lower[axis][k]);
        box.upper[a] = origin_[a] + static_cast<double>(node.boxes.upper[axis][k]);
      }
      if (level <= 0)
        boxes.back().add(box);
      else
        boxes.push_back(box);
    }
  }
}

}  // namespace cloth
