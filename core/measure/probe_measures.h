// What probes at particles read off: pure functions of points, in m, that do not change when all of these are
// turned and moved together (with `up`, where there is one).
#pragma once

#include <span>

#include "params/parameter.h"

namespace cloth {

/// rad, 0 to pi, at `b` between the ways to `a` and `c`; not a number where one of these is at `b`.
double angle_at(const Vec3& a, const Vec3& b, const Vec3& c);

/// 1/m, one over the radius of the circle through three points: 4 area/(|ab| |bc| |ca|) (Menger 1930). Exact
/// for points of a circle; of a curve's three points at even steps h the curvature at the middle one with an
/// error of order h^2. Not a number where two points coincide.
double curvature_through(const Vec3& a, const Vec3& b, const Vec3& c);

/// m, along the points.
double length_of(std::span<const Vec3> points);

/// 1/m, largest curvature through three points in succession; not a number for less than three.
double largest_curvature(std::span<const Vec3> points);

/// m, largest depth of a point below the straight line from the first to the last, measured along `up` (a
/// unit vector); 0 where none is below. Not a number where one end is straight above the other.
double sag_below_chord(std::span<const Vec3> points, const Vec3& up);

/// Waves of the points to the sides of the vertical plane through the first and the last one: peaks to the
/// side that has more of them. Those count that rise and fall by more than `prominence`, m. Not a number
/// where one end is straight above the other.
double folds_along(std::span<const Vec3> points, const Vec3& up, double prominence);

}  // namespace cloth
