#include "geometry/closest_points.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace closest_points {

PointTriangle closest_of_edges(const Vec3& point, const std::array<Vec3, 3>& vertices,
                               const std::array<bool, 3>& beyond) {
  PointTriangle best;
  bool found = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!beyond[k]) continue;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const PointSegment edge = closest_on_segment(point, vertices[i], vertices[j]);
    if (found && !(edge.squared_distance < best.squared_distance)) continue;
    found = true;
    best.weights[k] = 0, best.weights[i] = 1 - edge.weight, best.weights[j] = edge.weight;
    best.separation = edge.separation, best.squared_distance = edge.squared_distance;
  }
  return best;
}

PointTriangle closest_on_slender(const Vec3& point, const std::array<Vec3, 3>& vertices,
                                 const PointTriangle& inner) {
  const PointTriangle edge = closest_of_edges(point, vertices, {true, true, true});
  // The place along a slender triangle is inexact, the place across it is not: the best along its longest
  // edge at the same distance from it.
  std::size_t apex = 0;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double squared = (vertices[(k + 2) % 3] - vertices[(k + 1) % 3]).squaredNorm();
    if (squared > longest) longest = squared, apex = k;
  }
  const std::size_t i = (apex + 1) % 3, j = (apex + 2) % 3;
  const double height = inner.weights[apex];
  const Vec3 along = vertices[j] - vertices[i];
  const Vec3 apart = point - vertices[i] - height * (vertices[apex] - vertices[i]);
  PointTriangle better;
  const double t = longest > 0 ? std::min(clamped(apart.dot(along) / longest), 1 - height) : 0;
  better.weights[apex] = height, better.weights[j] = t, better.weights[i] = clamped(1 - height - t);
  better.separation = apart - t * along;
  better.squared_distance = better.separation.squaredNorm();
  return edge.squared_distance < better.squared_distance ? edge : better;
}

SegmentSegment closest_with_an_end(const Vec3& apart, const Vec3& first, const Vec3& second) {
  const double first_squared = first.squaredNorm(), second_squared = second.squaredNorm();
  SegmentSegment best;
  best.squared_distance = HUGE_VAL;
  const auto consider = [&](double s, double t) {
    const SegmentSegment pair = at_weights_of_both(apart, first, second, s, t);
    if (pair.squared_distance < best.squared_distance) best = pair;
  };
  const auto along = [](const Vec3& from, const Vec3& direction, double squared) {
    return squared > 0 ? clamped(from.dot(direction) / squared) : 0;
  };
  consider(0, along(apart, second, second_squared));
  consider(1, along(apart + first, second, second_squared));
  consider(along(-apart, first, first_squared), 0);
  consider(along(second - apart, first, first_squared), 1);
  return best;
}

SegmentSegment closest_nearly_parallel(const Vec3& apart, const Vec3& first, const Vec3& second,
                                       const SegmentSegment& inner) {
  // The place along nearly parallel lines is inexact; the point across from it is not.
  const PointSegment across = from_first_end(apart + inner.first * first, second, second.squaredNorm());
  const SegmentSegment better = at_weights_of_both(apart, first, second, inner.first, across.weight);
  const SegmentSegment end = closest_with_an_end(apart, first, second);
  return end.squared_distance < better.squared_distance ? end : better;
}

}  // namespace closest_points

PointBox closest_on_box(const Vec3& point, const OrientedBox& box) {
  const Vec3 local = box.axes.transpose() * (point - box.center);
  const Vec3 within = local.cwiseMin(box.half).cwiseMax(-box.half);
  const Vec3 outward = local - within;
  PointBox result;
  result.distance = outward.stableNorm();
  if (result.distance > 0) {
    result.point = box.center + box.axes * within;
    result.normal = box.axes * (outward / result.distance);
    return result;
  }
  int axis = 0;
  const double depth = (box.half - local.cwiseAbs()).minCoeff(&axis);
  const double side = local[axis] < 0 ? -1 : 1;
  Vec3 surface = local;
  surface[axis] = side * box.half[axis];
  result.point = box.center + box.axes * surface;
  result.normal = side * box.axes.col(axis);
  result.distance = -depth;
  return result;
}

std::array<Vec3, 8> corners(const OrientedBox& box) {
  std::array<Vec3, 8> points;
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 side((k & 1) ? 1 : -1, (k & 2) ? 1 : -1, (k & 4) ? 1 : -1);
    points[k] = box.center + box.axes * side.cwiseProduct(box.half);
  }
  return points;
}

}  // namespace cloth
