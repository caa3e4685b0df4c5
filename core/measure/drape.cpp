#include "measure/drape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace cloth {
namespace {

using Eigen::Vector2d;

/// Positions in the horizontal plane, from the disc's middle.
std::vector<Vector2d> seen_from_above(const Vec3Field& position, const DrapeDisc& disc) {
  const Vec3 first = disc.up.unitOrthogonal(), second = disc.up.cross(first);
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 from_middle = position[i] - disc.middle;
    points.emplace_back(first.dot(from_middle), second.dot(from_middle));
  }
  return points;
}

/// From where to where something reaches along a line.
using Interval = std::pair<double, double>;

/// Where the line y = `height` is within a triangle.
Interval cut_of(const std::array<Vector2d, 3>& corners, double height) {
  Interval cut{1, -1};  // nowhere
  const auto extend = [&](double x) {
    cut = cut.first > cut.second ? Interval{x, x} : Interval{std::min(cut.first, x), std::max(cut.second, x)};
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector2d &from = corners[k], &to = corners[(k + 1) % 3];
    if ((from.y() <= height) == (to.y() <= height)) continue;
    extend(from.x() + (to.x() - from.x()) * (height - from.y()) / (to.y() - from.y()));
  }
  return cut;
}

double length_of_union(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0, reached = -std::numeric_limits<double>::infinity();
  for (const auto& [begin, end] : intervals) {
    length += std::max(0.0, end - std::max(begin, reached));
    reached = std::max(reached, end);
  }
  return length;
}

bool are_finite(const std::vector<Vector2d>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vector2d& point) { return point.allFinite(); });
}

/// The outline without what is shorter than a 24th of the way around.
std::vector<double> smooth(const std::vector<double>& outline) {
  constexpr int harmonics = 24;
  const auto count = static_cast<double>(outline.size());
  std::vector<double> sum(outline.size(), 0);
  for (int h = 0; h <= harmonics; ++h) {
    double cosine = 0, sine = 0;
    const auto angle = [&](std::size_t k) {
      return 2 * std::numbers::pi * h * static_cast<double>(k) / count;
    };
    for (std::size_t k = 0; k < outline.size(); ++k)
      cosine += outline[k] * std::cos(angle(k)), sine += outline[k] * std::sin(angle(k));
    const double scale = (h == 0 ? 1 : 2) / count;
    for (std::size_t k = 0; k < outline.size(); ++k)
      sum[k] += scale * (cosine * std::cos(angle(k)) + sine * std::sin(angle(k)));
  }
  return sum;
}

double flat_area(const std::vector<Triangle>& triangles, const Vec3Field& flat) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vec3 first = flat[static_cast<std::size_t>(a)];
    const Vec3 u = flat[static_cast<std::size_t>(b)] - first, v = flat[static_cast<std::size_t>(c)] - first;
    area += 0.5 * u.cross(v).norm();
  }
  return area;
}

}  // namespace

double shadow_area(const std::vector<Triangle>& triangles, const Vec3Field& position, const DrapeDisc& disc,
                   int lines) {
  const std::vector<Vector2d> points = seen_from_above(position, disc);
  if (!are_finite(points)) return std::numeric_limits<double>::quiet_NaN();
  double low = -disc.radius, high = disc.radius;
  for (const Vector2d& point : points) low = std::min(low, point.y()), high = std::max(high, point.y());
  const double spacing = (high - low) / lines;
  if (!(spacing > 0)) return 0;  // seen edge-on, along the lines
  const auto height_of = [&](int line) { return low + (line + 0.5) * spacing; };
  const auto line_at = [&](double y) {  // the first that is not below y
    return std::clamp(static_cast<int>(std::ceil((y - low) / spacing - 0.5)), 0, lines);
  };
  std::vector<std::vector<Interval>> intervals(static_cast<std::size_t>(lines));
  for (const Triangle& t : triangles) {
    std::array<Vector2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = points[static_cast<std::size_t>(t[k])];
    const auto [least, most] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    for (int line = line_at(least); line < std::min(lines, line_at(most) + 1); ++line) {
      const Interval cut = cut_of(corners, height_of(line));
      if (cut.first < cut.second) intervals[static_cast<std::size_t>(line)].push_back(cut);
    }
  }
  double area = 0;
  for (int line = 0; line < lines; ++line) {
    std::vector<Interval>& along = intervals[static_cast<std::size_t>(line)];
    const double square = disc.radius * disc.radius - height_of(line) * height_of(line);
    if (square > 0) along.emplace_back(-std::sqrt(square), std::sqrt(square));
    area += spacing * length_of_union(along);
  }
  return area;
}

std::vector<double> shadow_outline(const std::vector<Triangle>& triangles, const Vec3Field& position,
                                   const DrapeDisc& disc, int directions) {
  const std::vector<Vector2d> points = seen_from_above(position, disc);
  std::vector<double> outline(static_cast<std::size_t>(directions), disc.radius);
  if (!are_finite(points)) {
    std::ranges::fill(outline, std::numeric_limits<double>::quiet_NaN());
    return outline;
  }
  const double step = 2 * std::numbers::pi / directions;
  const auto look_at_edge = [&](const Vector2d& p, const Vector2d& q) {
    const double begin = std::atan2(p.y(), p.x());
    const double turn = std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
    const double from = std::min(begin, begin + turn), to = std::max(begin, begin + turn);
    // A ray through a corner meets both edges there, rounding or not.
    constexpr double rounding = 1e-9;
    for (int k = static_cast<int>(std::ceil(from / step - rounding)); k * step <= to + rounding * step; ++k) {
      const Vector2d ray(std::cos(k * step), std::sin(k * step)), along = q - p;
      const double across = ray.x() * along.y() - ray.y() * along.x();
      const double part = across == 0 ? 1 : (ray.y() * p.x() - ray.x() * p.y()) / across;
      const double radius = ray.dot(p + std::clamp(part, 0.0, 1.0) * along);
      double& furthest = outline[static_cast<std::size_t>(((k % directions) + directions) % directions)];
      furthest = std::max(furthest, radius);
    }
  };
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      look_at_edge(points[static_cast<std::size_t>(t[k])], points[static_cast<std::size_t>(t[(k + 1) % 3])]);
  return outline;
}

FoldCount count_folds(const std::vector<double>& outline, double prominence) {
  const std::vector<double> radius = smooth(outline);
  const auto lowest =
      static_cast<std::size_t>(std::min_element(radius.begin(), radius.end()) - radius.begin());
  FoldCount count;
  double peaks = 0, valleys = 0, extreme = radius[lowest];
  bool rises = false;
  for (std::size_t k = 0; k <= radius.size(); ++k) {
    const double here = radius[(lowest + k) % radius.size()];
    if (!rises && here > extreme + prominence) {
      valleys += extreme, extreme = here, rises = true;
    } else if (rises && here < extreme - prominence) {
      peaks += extreme, extreme = here, rises = false;
      ++count.folds;
    }
    extreme = rises ? std::max(extreme, here) : std::min(extreme, here);
  }
  if (count.folds > 1) count.amplitude = 0.5 * (peaks - valleys) / count.folds;
  return count;
}

Drape measure_drape(const std::vector<Triangle>& triangles, const Vec3Field& flat, const Vec3Field& position,
                    const DrapeDisc& disc) {
  Drape drape{.shadow = shadow_area(triangles, position, disc), .specimen = flat_area(triangles, flat)};
  const double under = std::numbers::pi * disc.radius * disc.radius;
  drape.coefficient = (drape.shadow - under) / (drape.specimen - under);
  const double radius = std::sqrt(drape.specimen / std::numbers::pi);
  const std::vector<double> cut = shadow_outline(triangles, flat, disc);
  std::vector<double> outline = shadow_outline(triangles, position, disc);
  for (std::size_t k = 0; k < outline.size(); ++k) outline[k] += radius - cut[k];
  constexpr double prominent = 0.02;  // of the specimen's radius
  const FoldCount found = count_folds(outline, prominent * radius);
  drape.folds = found.folds, drape.amplitude = found.amplitude;
  return drape;
}

}  // namespace cloth
