#include "geometry/polygon.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "geometry/polygon_sweep.h"

namespace cloth {
namespace {

/// Newell's normal: the sum of the cross products of consecutive corners, valid for any shape.
Vec3 normal_of(const std::vector<Vec3>& vertices, std::span<const int> corners) {
  const Vec3 first = vertices[static_cast<std::size_t>(corners[0])];
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    sum += (vertices[static_cast<std::size_t>(corners[k])] - first)
               .cross(vertices[static_cast<std::size_t>(corners[k + 1])] - first);
  return sum;
}

/// In the coordinate plane that the polygon lies most nearly in, so that it turns left.
FlatPolygon flattened(const std::vector<Vec3>& vertices, std::span<const int> corners) {
  const Vec3 normal = normal_of(vertices, corners);
  FlatPolygon polygon;
  normal.cwiseAbs().maxCoeff(&polygon.axis);
  polygon.seen_from_below = normal[polygon.axis] < 0;
  polygon.points.reserve(corners.size());
  for (const int corner : corners) polygon.points.push_back(vertices[static_cast<std::size_t>(corner)]);
  return polygon;
}

/// Whether triangles of a polygon cover it once: each turns as it does, or has no area.
bool cover_once(const FlatPolygon& polygon, const std::vector<Triangle>& triangles) {
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return polygon.turn(t[0], t[1], t[2]) >= 0; });
}

/// Ear clipping (Meisters 1975), for polygons that touch or cross themselves. A raster over the reflex
/// corners finds those within an ear.
class EarCutter {
 public:
  explicit EarCutter(const FlatPolygon& polygon)
      : polygon_(polygon),
        next_(polygon.size()),
        previous_(polygon.size()),
        blocks_(polygon.size()),
        looks_left_(std::clamp(looks_for_a_corner * polygon.size(), least_looks, max_looks)) {
    const auto count = static_cast<int>(polygon.size());
    for (int k = 0; k < count; ++k) {
      next_[at(k)] = (k + 1) % count;
      previous_[at(k)] = (k + count - 1) % count;
    }
    for (int k = 0; k < count; ++k) blocks_[at(k)] = !turns_left(k);
    fill_grid();
  }

  /// Positions within the polygon's corners. Empty: it took too long.
  std::vector<Triangle> cut() {
    std::vector<Triangle> triangles;
    int left = static_cast<int>(polygon_.size()), corner = 0, refused = 0;
    while (left >= 3) {
      if (looks_left_ == 0) return {};
      const bool cuts = is_ear(corner) || refused > left;  // none left: it crosses itself, or has no area
      if (!cuts) {
        corner = next_[at(corner)];
        ++refused;
        continue;
      }
      const int before = previous_[at(corner)], after = next_[at(corner)];
      triangles.push_back({before, corner, after});
      next_[at(before)] = after;
      previous_[at(after)] = before;
      blocks_[at(corner)] = false;
      for (const int neighbour : {before, after})
        if (blocks_[at(neighbour)]) blocks_[at(neighbour)] = !turns_left(neighbour);
      --left;
      refused = 0;
      corner = next_[at(after)];  // not beside the last ear: fans of slivers grow that way
    }
    return triangles;
  }

 private:
  static constexpr std::size_t looks_for_a_corner = 60, least_looks = 100'000, max_looks = 20'000'000;

  bool turns_left(int corner) const {
    return polygon_.turn(previous_[at(corner)], corner, next_[at(corner)]) > 0;
  }

  void fill_grid() {
    low_ = high_ = place_of(0);
    int blocking = 0;
    const auto count = static_cast<int>(polygon_.size());
    for (int k = 0; k < count; ++k) {
      low_ = low_.cwiseMin(place_of(k));
      high_ = high_.cwiseMax(place_of(k));
      blocking += blocks_[at(k)] ? 1 : 0;
    }
    cells_ = std::max(1, static_cast<int>(std::sqrt(blocking)));
    grid_.assign(at(cells_) * at(cells_), {});
    for (int k = 0; k < count; ++k)
      if (blocks_[at(k)]) grid_[cell_at(cell_of(place_of(k), 0), cell_of(place_of(k), 1))].push_back(k);
  }

  Eigen::Vector2d place_of(int corner) const { return {polygon_.across(corner), polygon_.up(corner)}; }

  std::size_t cell_at(int x, int y) const { return at(y) * at(cells_) + at(x); }

  int cell_of(const Eigen::Vector2d& point, Eigen::Index axis) const {
    const double span = high_[axis] - low_[axis];
    if (!(span > 0)) return 0;
    return std::clamp(static_cast<int>((point[axis] - low_[axis]) / span * cells_), 0, cells_ - 1);
  }

  /// Whether the corner is convex and no reflex corner lies within its triangle.
  bool is_ear(int corner) {
    look();
    if (!turns_left(corner)) return false;
    const Triangle ear{previous_[at(corner)], corner, next_[at(corner)]};
    Eigen::Vector2d low = place_of(corner), high = low;
    for (const int end : {ear[0], ear[2]})
      low = low.cwiseMin(place_of(end)), high = high.cwiseMax(place_of(end));
    const int x_end = cell_of(high, 0), y_begin = cell_of(low, 1), y_end = cell_of(high, 1);
    for (int x = cell_of(low, 0); x <= x_end; ++x)
      for (int y = y_begin; y <= y_end; ++y)
        if (is_blocked(grid_[cell_at(x, y)], ear)) return false;
    return true;
  }

  /// Points at the place of a corner of the triangle do not block it: a hole hangs on the outline by a seam.
  bool is_blocked(std::vector<int>& cell, const Triangle& ear) {
    look();
    for (std::size_t k = 0; k < cell.size();) {
      look();
      if (!blocks_[at(cell[k])]) {  // cut off since, or turning out since
        cell[k] = cell.back();
        cell.pop_back();
        continue;
      }
      const int p = cell[k++];
      const auto is_there = [&](int corner) { return polygon_.point(p) == polygon_.point(corner); };
      if (std::any_of(ear.begin(), ear.end(), is_there)) continue;
      if (polygon_.turn(ear[0], ear[1], p) >= 0 && polygon_.turn(ear[1], ear[2], p) >= 0 &&
          polygon_.turn(ear[2], ear[0], p) >= 0)
        return true;
    }
    return false;
  }

  void look() {
    if (looks_left_ > 0) --looks_left_;
  }

  const FlatPolygon& polygon_;
  std::vector<int> next_, previous_;
  std::vector<bool> blocks_;  ///< does not turn left, and is not cut off
  std::size_t looks_left_;    ///< at cells and corners, before this takes too long
  Eigen::Vector2d low_, high_;
  int cells_ = 1;  ///< of the grid, along each axis
  std::vector<std::vector<int>> grid_;
};

}  // namespace

std::vector<Triangle> cut_polygon(const std::vector<Vec3>& vertices, std::span<const int> corners) {
  const FlatPolygon polygon = flattened(vertices, corners);
  std::vector<Triangle> triangles = sweep_polygon(polygon).value_or(std::vector<Triangle>{});
  if (triangles.empty() || !cover_once(polygon, triangles)) triangles = EarCutter(polygon).cut();
  for (Triangle& triangle : triangles)
    for (int& corner : triangle) corner = corners[static_cast<std::size_t>(corner)];
  return triangles;
}

}  // namespace cloth
