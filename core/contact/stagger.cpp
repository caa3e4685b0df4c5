#include "contact/stagger.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

/// Whether all positions lie in one plane, up to rounding.
bool is_flat(const Surface& surface, const Vec3Field& position) {
  Vec3 normal = Vec3::Zero();
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 other = (position[at(b)] - position[at(a)]).cross(position[at(c)] - position[at(a)]);
    if (other.squaredNorm() > normal.squaredNorm()) normal = other;
  }
  constexpr double rounding = 1e-6;
  double extent = 0, height = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 from = position[i] - position[0];
    extent = std::max(extent, from.norm());
    height = std::max(height, std::abs(normal.normalized().dot(from)));
  }
  return height <= rounding * extent;
}

/// Whether a cloth could lie on one obstacle and be compressed by another.
bool can_be_compressed(const std::vector<Obstacle>& obstacles) {
  const auto is_floor = [](const Obstacle& o) {
    const BodyKind kind = shape_of(o).body;
    return !moves(o) && (kind == BodyKind::half_space || kind == BodyKind::box);
  };
  const auto is_press = [](const Obstacle& o) { return moves(o) && shape_of(o).body != BodyKind::ball; };
  return std::any_of(obstacles.begin(), obstacles.end(), is_floor) &&
         std::any_of(obstacles.begin(), obstacles.end(), is_press);
}

/// In [0, 1), evenly distributed over the particles (Knuth's multiplicative hash).
double perturbation_of(int particle) {
  return static_cast<double>(static_cast<std::uint32_t>(particle) * 2654435761u) * 0x1p-32;
}

}  // namespace

bool needs_stagger(const std::vector<Obstacle>& obstacles, const Surface& surface, const Vec3Field& start) {
  return can_be_compressed(obstacles) && is_flat(surface, start);
}

double staggered(double thickness, int particle) {
  constexpr double most = 0.005;  // of the thickness
  return thickness * (1 + most * perturbation_of(particle));
}

}  // namespace cloth
