#include "sweep/contour.h"

#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <optional>

namespace cloth {
namespace {

/// An edge of the grid: from node (ix, iy) to the right, or up.
struct Edge {
  std::size_t node = 0;
  bool is_up = false;
  auto operator<=>(const Edge&) const = default;
};

/// The segments of a level, by the edges that they join.
class Segments {
 public:
  Segments(std::span<const double> x, std::span<const double> y, std::span<const double> values, double level)
      : x_(x), y_(y), values_(values), level_(level) {
    for (std::size_t iy = 0; iy + 1 < y.size(); ++iy)
      for (std::size_t ix = 0; ix + 1 < x.size(); ++ix) add_cell(ix, iy);
  }

  /// Joins segments to lines from end to end.
  std::vector<std::vector<ContourPoint>> lines() {
    std::vector<std::vector<ContourPoint>> all;
    while (!next_.empty()) {
      const Edge start = next_.begin()->first;
      std::deque<Edge> chain{start};
      while (const auto edge = taken_from(chain.back())) chain.push_back(*edge);
      while (const auto edge = taken_from(chain.front())) chain.push_front(*edge);
      std::vector<ContourPoint>& line = all.emplace_back();
      for (const Edge& edge : chain) line.push_back(place_of(edge));
    }
    return all;
  }

 private:
  double value(std::size_t ix, std::size_t iy) const { return values_[iy * x_.size() + ix]; }

  void add_cell(std::size_t ix, std::size_t iy) {
    const double corners[4] = {value(ix, iy), value(ix + 1, iy), value(ix + 1, iy + 1), value(ix, iy + 1)};
    double middle = 0;
    for (const double corner : corners) {
      if (!std::isfinite(corner)) return;
      middle += 0.25 * corner;
    }
    const std::size_t node = iy * x_.size() + ix;
    const std::array<Edge, 4> edges{Edge{node, false}, Edge{node + 1, true}, Edge{node + x_.size(), false},
                                    Edge{node, true}};
    std::vector<Edge> crossed;
    for (std::size_t k = 0; k < 4; ++k)
      if ((corners[k] > level_) != (corners[(k + 1) % 4] > level_)) crossed.push_back(edges[k]);
    if (crossed.size() == 2) join(crossed[0], crossed[1]);
    if (crossed.size() < 4) return;
    // A saddle: its middle says which corners belong together.
    const bool with_first = (middle > level_) == (corners[0] > level_);
    join(crossed[0], crossed[with_first ? 1 : 3]);
    join(crossed[2], crossed[with_first ? 3 : 1]);
  }

  void join(const Edge& a, const Edge& b) {
    next_.emplace(a, b);
    next_.emplace(b, a);
  }

  /// The other end of a segment that ends here; the segment is used up.
  std::optional<Edge> taken_from(const Edge& edge) {
    const auto found = next_.find(edge);
    if (found == next_.end()) return std::nullopt;
    const Edge other = found->second;
    next_.erase(found);
    for (auto [at, end] = next_.equal_range(other); at != end; ++at)
      if (at->second == edge) {
        next_.erase(at);
        break;
      }
    return other;
  }

  ContourPoint place_of(const Edge& edge) const {
    const std::size_t ix = edge.node % x_.size(), iy = edge.node / x_.size();
    const double from = value(ix, iy), to = edge.is_up ? value(ix, iy + 1) : value(ix + 1, iy);
    const double t = (level_ - from) / (to - from);
    return edge.is_up ? ContourPoint(x_[ix], y_[iy] + t * (y_[iy + 1] - y_[iy]))
                      : ContourPoint(x_[ix] + t * (x_[ix + 1] - x_[ix]), y_[iy]);
  }

  std::span<const double> x_, y_, values_;
  double level_;
  std::multimap<Edge, Edge> next_;
};

}  // namespace

std::vector<std::vector<ContourPoint>> contour_lines(std::span<const double> x, std::span<const double> y,
                                                     std::span<const double> values, double level) {
  return Segments(x, y, values, level).lines();
}

}  // namespace cloth
