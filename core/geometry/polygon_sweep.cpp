#include "geometry/polygon_sweep.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "geometry/exact_signs.h"

namespace cloth {
namespace {

constexpr int none = -1;

std::size_t place(int index) {
  return static_cast<std::size_t>(index);
}

/// The sweep line crosses slabs of the polygon's interior, each between an edge to its left and one to its
/// right. The part of a slab that is not triangulated yet lies below a reflex chain of points from the left
/// edge to the right one: convex points of the chain have been cut off as triangles.
class Sweep {
 public:
  explicit Sweep(const FlatPolygon& polygon)
      : polygon_(polygon),
        count_(static_cast<int>(polygon.size())),
        rank_(polygon.size()),
        slab_right_of_(polygon.size(), none),
        slab_left_of_(polygon.size(), none),
        lefts_(Order{this}) {}

  std::optional<std::vector<Triangle>> run() {
    std::vector<int> order(place(count_));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [this](int a, int b) { return is_above(a, b); });
    for (int k = 0; k < count_; ++k) rank_[place(order[place(k)])] = k;
    for (const int point : order)
      if (!pass(point)) return std::nullopt;
    if (triangles_.size() + 2 != polygon_.size()) return std::nullopt;
    return std::move(triangles_);
  }

 private:
  struct Node {  ///< of a chain
    int point, left = none, right = none;
  };
  struct Slab {
    int left_edge, right_edge;
    int first, last, lowest;  ///< nodes
  };

  // An edge has the number of the point that it starts at.
  int next(int k) const { return k + 1 == count_ ? 0 : k + 1; }
  int previous(int k) const { return k == 0 ? count_ - 1 : k - 1; }
  int upper(int edge) const { return comes_first(edge, next(edge)) ? edge : next(edge); }
  int lower(int edge) const { return comes_first(edge, next(edge)) ? next(edge) : edge; }

  bool is_above(int a, int b) const {
    if (polygon_.up(a) != polygon_.up(b)) return polygon_.up(a) > polygon_.up(b);
    if (polygon_.across(a) != polygon_.across(b)) return polygon_.across(a) < polygon_.across(b);
    return a < b;
  }
  bool comes_first(int a, int b) const { return rank_[place(a)] < rank_[place(b)]; }

  /// Edges at the sweep line from left to right.
  struct Order {
    const Sweep* sweep;
    using is_transparent = void;
    struct At {
      int point;
    };
    /// 1 where the point lies left of the edge.
    int side(int edge, int point) const {
      return -sweep->polygon_.turn(sweep->upper(edge), sweep->lower(edge), point);
    }
    bool operator()(int a, int b) const {
      if (a == b) return false;
      if (sweep->comes_first(sweep->upper(a), sweep->upper(b))) {
        const int of_upper = side(a, sweep->upper(b));
        return (of_upper != 0 ? of_upper : side(a, sweep->lower(b))) < 0;
      }
      const int of_upper = side(b, sweep->upper(a));
      return (of_upper != 0 ? of_upper : side(b, sweep->lower(a))) > 0;
    }
    bool operator()(At at, int edge) const { return side(edge, at.point) > 0; }
    bool operator()(int edge, At at) const { return side(edge, at.point) < 0; }
  };

  int new_node(int point) {
    nodes_.push_back({point});
    return static_cast<int>(nodes_.size()) - 1;
  }
  Node& node(int index) { return nodes_[place(index)]; }
  void link(int left, int right) { node(left).right = right, node(right).left = left; }

  void cut(int a, int b, int c) { triangles_.push_back({node(a).point, node(b).point, node(c).point}); }

  /// Cuts off triangles between `at` and the chain to its left, which ends in `last`, until the chain is
  /// reflex, or all of them if `all`. Returns the end of the remaining chain.
  int cut_leftwards(int at, int last, bool all = false) {
    while (node(last).left != none &&
           (all || polygon_.turn(node(at).point, node(last).point, node(node(last).left).point) > 0)) {
      cut(at, last, node(last).left);
      last = node(last).left;
    }
    return last;
  }
  int cut_rightwards(int at, int first) {
    while (node(first).right != none &&
           polygon_.turn(node(node(first).right).point, node(first).point, node(at).point) > 0) {
      cut(node(first).right, first, at);
      first = node(first).right;
    }
    return first;
  }

  /// False: the polygon is not simple.
  bool open_slab(int left_edge, int right_edge, int first, int last, int lowest_node) {
    const int slab = static_cast<int>(slabs_.size());
    slabs_.push_back({left_edge, right_edge, first, last, lowest_node});
    node(first).left = none;
    node(last).right = none;
    slab_right_of_[place(left_edge)] = slab;
    slab_left_of_[place(right_edge)] = slab;
    return lefts_.insert(left_edge).second;
  }

  /// Takes a slab out; false if there is none.
  bool close_slab(int index, Slab& slab) {
    if (index == none) return false;
    slab = slabs_[place(index)];
    if (slab.left_edge == none) return false;
    slabs_[place(index)].left_edge = none;
    return lefts_.erase(slab.left_edge) == 1;
  }

  bool pass(int point) {
    const int before = previous(point), after = next(point);
    const bool first_above = comes_first(before, point), second_above = comes_first(after, point);
    const bool turns_in = polygon_.turn(before, point, after) < 0;
    if (!first_above && !second_above) return turns_in ? split(point) : start(point);
    if (first_above && second_above) return turns_in ? merge(point) : end(point);
    return first_above ? go_on_at_left(point) : go_on_at_right(point);
  }

  bool start(int point) {
    const int at = new_node(point);
    return open_slab(point, previous(point), at, at, at);
  }

  bool end(int point) {
    Slab slab;
    if (slab_right_of_[place(previous(point))] != slab_left_of_[place(point)] ||
        !close_slab(slab_left_of_[place(point)], slab))
      return false;
    cut_leftwards(new_node(point), slab.last, true);
    return true;
  }

  bool go_on_at_left(int point) {
    Slab slab;
    if (!close_slab(slab_right_of_[place(previous(point))], slab)) return false;
    const int at = new_node(point);
    const int first = cut_rightwards(at, slab.first);
    link(at, first);
    return open_slab(point, slab.right_edge, at, slab.last, at);
  }

  bool go_on_at_right(int point) {
    Slab slab;
    if (!close_slab(slab_left_of_[place(point)], slab)) return false;
    const int at = new_node(point);
    const int last = cut_leftwards(at, slab.last);
    link(last, at);
    return open_slab(slab.left_edge, previous(point), slab.first, at, at);
  }

  /// The interior continues to the left and to the right of the point.
  bool split(int point) {
    const auto beyond = lefts_.upper_bound(typename Order::At{point});
    if (beyond == lefts_.begin()) return false;
    Slab slab;
    if (!close_slab(slab_right_of_[place(*std::prev(beyond))], slab)) return false;
    const int middle = slab.lowest, copy = new_node(node(middle).point);
    const int to_the_right = node(middle).right;
    if (to_the_right != none) link(copy, to_the_right);
    const int right_end = to_the_right != none ? slab.last : copy;
    const int at_left = new_node(point), at_right = new_node(point);
    link(cut_leftwards(at_left, middle), at_left);
    link(at_right, cut_rightwards(at_right, copy));
    return open_slab(slab.left_edge, previous(point), slab.first, at_left, at_left) &&
           open_slab(point, slab.right_edge, at_right, right_end, at_right);
  }

  /// Two slabs become one below the point.
  bool merge(int point) {
    Slab left, right;
    if (!close_slab(slab_left_of_[place(point)], left) ||
        !close_slab(slab_right_of_[place(previous(point))], right))
      return false;
    const int at = new_node(point);
    link(cut_leftwards(at, left.last), at);
    link(at, cut_rightwards(at, right.first));
    return open_slab(left.left_edge, right.right_edge, left.first, right.last, at);
  }

  const FlatPolygon& polygon_;
  int count_;
  std::vector<int> rank_;  ///< in the order of the sweep
  std::vector<Node> nodes_;
  std::vector<Slab> slabs_;
  std::vector<int> slab_right_of_, slab_left_of_;  ///< of each edge, where it bounds one
  std::set<int, Order> lefts_;                     ///< left edges of slabs
  std::vector<Triangle> triangles_;
};

}  // namespace

int FlatPolygon::turn(int a, int b, int c) const {
  const int sign = turn_around(axis, point(a), point(b), point(c));
  return seen_from_below ? -sign : sign;
}

std::optional<std::vector<Triangle>> sweep_polygon(const FlatPolygon& polygon) {
  return Sweep(polygon).run();
}

}  // namespace cloth
