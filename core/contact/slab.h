// Bounds of triangles whose vertices may be anywhere in a region each: fast tests that two triangles cannot
// collide. They use separating axes (Gottschalk et al. 1996): bounding boxes test the coordinate axes, slabs
// the triangles' normals.
#pragma once

#include <algorithm>
#include <array>

#include "geometry/bounds.h"

namespace cloth {

/// All points within `radius` of a segment: bounds a particle in a round.
struct Capsule {
  Vec3 from{0, 0, 0}, to{0, 0, 0};  ///< m
  double radius = 0;                ///< m

  Capsule grown(double margin) const { return {from, to, radius + margin}; }
};

/// Bounds a particle that moves less than `radius` in any direction.
struct Ball {
  Vec3 center{0, 0, 0};  ///< m
  double radius = 0;     ///< m

  Ball grown(double margin) const { return {center, radius + margin}; }
};

struct Interval {
  double low = Bounds::infinity, high = -Bounds::infinity;  ///< empty by default

  void add(const Interval& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

// Regions of a vertex: a box, a capsule, a ball, a point.
inline const Bounds& box_of(const Bounds& box) {
  return box;
}
inline Bounds box_of(const Capsule& capsule) {
  return bounds_of(capsule.from, capsule.to).grown(capsule.radius);
}
inline Bounds box_of(const Ball& ball) {
  return bounds_of(ball.center).grown(ball.radius);
}
inline Bounds box_of(const Vec3& point) {
  return {point, point};
}

inline Vec3 middle_of(const Bounds& box) {
  return 0.5 * (box.lower + box.upper);
}
inline Vec3 middle_of(const Capsule& capsule) {
  return 0.5 * (capsule.from + capsule.to);
}
inline const Vec3& middle_of(const Ball& ball) {
  return ball.center;
}
inline const Vec3& middle_of(const Vec3& point) {
  return point;
}

/// The extent of a region along a unit axis.
inline Interval along(const Vec3& axis, const Bounds& box) {
  const double middle = axis.dot(middle_of(box));
  const double half = 0.5 * axis.cwiseAbs().dot(box.upper - box.lower);
  return {middle - half, middle + half};
}
inline Interval along(const Vec3& axis, const Capsule& capsule) {
  const double from = axis.dot(capsule.from), to = axis.dot(capsule.to);
  return {std::min(from, to) - capsule.radius, std::max(from, to) + capsule.radius};
}
inline Interval along(const Vec3& axis, const Ball& ball) {
  const double level = axis.dot(ball.center);
  return {level - ball.radius, level + ball.radius};
}
inline Interval along(const Vec3& axis, const Vec3& point) {
  const double level = axis.dot(point);
  return {level, level};
}

struct Slab {
  Bounds box;
  Vec3 normal{0, 0, 0};  ///< unit normal of the triangle of the regions' centres; zero without area
  Interval extent;       ///< of the whole triangle along the normal

  /// 1 where `other` lies wholly above the triangle, -1 below, 0 otherwise.
  int side_of(const Interval& other) const {
    return (other.low > extent.high ? 1 : 0) - (other.high < extent.low ? 1 : 0);
  }
};

template <class Region>
Slab slab_of(const Region& a, const Region& b, const Region& c) {
  Slab slab;
  slab.box.add(box_of(a)), slab.box.add(box_of(b)), slab.box.add(box_of(c));
  const Vec3 middle = middle_of(a);
  slab.normal = (middle_of(b) - middle).cross(middle_of(c) - middle);
  const double length = slab.normal.norm();
  slab.normal = length > 0 ? Vec3(slab.normal / length) : Vec3::Zero();
  for (const Region* region : {&a, &b, &c}) slab.extent.add(along(slab.normal, *region));
  return slab;
}

/// side_of() of a triangle's three vertices.
using Sides = std::array<int, 3>;

inline bool all_beyond(const Sides& sides) {
  return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}
inline bool edge_beyond(const Sides& sides, std::size_t k) {
  return sides[k] != 0 && sides[k] == sides[(k + 1) % 3];
}

}  // namespace cloth
