#include "measure/probe_measures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace cloth {
namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// From the first point to the last in the level plane; nullopt where that is nothing beside their distance.
std::optional<Vec3> level_chord(std::span<const Vec3> points, const Vec3& up) {
  constexpr double straight_above = 1e-9;  // of the distance
  const Vec3 chord = points.back() - points.front();
  const Vec3 level = chord - chord.dot(up) * up;
  if (!(level.norm() > straight_above * chord.norm())) return std::nullopt;
  return level;
}

/// Maxima with a rise before and a fall after them of more than `prominence`.
int count_peaks(const std::vector<double>& values, double prominence) {
  int peaks = 0;
  bool rises = false;
  double extreme = values.front();
  for (const double value : values) {
    if (!rises && value > extreme + prominence) {
      rises = true, extreme = value;
    } else if (rises && value < extreme - prominence) {
      rises = false, extreme = value, ++peaks;
    }
    extreme = rises ? std::max(extreme, value) : std::min(extreme, value);
  }
  return peaks;
}

}  // namespace

double angle_at(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - b, v = c - b;
  if (!(u.norm() > 0) || !(v.norm() > 0)) return undefined;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double curvature_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - b, v = c - b;
  return 2 * u.cross(v).norm() / (u.norm() * v.norm() * (c - a).norm());  // twice the area in the numerator
}

double length_of(std::span<const Vec3> points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
  return length;
}

double largest_curvature(std::span<const Vec3> points) {
  double largest = undefined;
  for (std::size_t k = 2; k < points.size(); ++k)
    largest = std::fmax(largest, curvature_through(points[k - 2], points[k - 1], points[k]));
  return largest;
}

double sag_below_chord(std::span<const Vec3> points, const Vec3& up) {
  const auto level = level_chord(points, up);
  if (!level) return undefined;
  const Vec3 chord = points.back() - points.front();
  double sag = 0;
  for (const Vec3& point : points) {
    const Vec3 from_first = point - points.front();
    const double part = from_first.dot(*level) / level->squaredNorm();
    sag = std::max(sag, (part * chord - from_first).dot(up));
  }
  return sag;
}

double folds_along(std::span<const Vec3> points, const Vec3& up, double prominence) {
  const auto level = level_chord(points, up);
  if (!level) return undefined;
  const Vec3 aside = level->normalized().cross(up);
  std::vector<double> one_side, other_side;
  for (const Vec3& point : points) {
    one_side.push_back((point - points.front()).dot(aside));
    other_side.push_back(-one_side.back());
  }
  return std::max(count_peaks(one_side, prominence), count_peaks(other_side, prominence));
}

}  // namespace cloth
