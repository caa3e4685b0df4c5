#include "geometry/bunny.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/surface_nets.h"

namespace cloth {
namespace {

/// An ellipsoid and the width of its smooth union with the parts before it.
struct Part {
  Vec3 centre, radii;  // m
  double melt;         // m
};

/// A capsule between two points, with different radii at its ends.
struct Limb {
  Vec3 from, to;       // m
  double radius, end;  // m
  double melt;
};

// One half: z is mirrored.
const std::array<Part, 9> parts{{
    {{-0.06, 0.30, 0.00}, {0.32, 0.27, 0.235}, 0.00},     // trunk
    {{0.13, 0.31, 0.00}, {0.17, 0.22, 0.17}, 0.10},       // chest
    {{-0.15, 0.20, 0.15}, {0.19, 0.20, 0.11}, 0.05},      // haunch
    {{0.20, 0.50, 0.00}, {0.11, 0.13, 0.105}, 0.10},      // neck
    {{0.27, 0.595, 0.00}, {0.155, 0.125, 0.12}, 0.05},    // head
    {{0.375, 0.555, 0.00}, {0.075, 0.062, 0.07}, 0.05},   // muzzle
    {{0.31, 0.56, 0.06}, {0.075, 0.07, 0.06}, 0.04},      // cheek
    {{-0.385, 0.24, 0.00}, {0.085, 0.08, 0.08}, 0.03},    // tail
    {{0.345, 0.63, 0.085}, {0.025, 0.028, 0.02}, 0.015},  // eye
}};
const std::array<Limb, 3> limbs{{
    {{0.215, 0.66, 0.05}, {0.04, 0.94, 0.115}, 0.045, 0.05, 0.03},   // ear
    {{0.20, 0.22, 0.095}, {0.23, 0.06, 0.10}, 0.062, 0.05, 0.05},    // foreleg
    {{-0.16, 0.055, 0.17}, {0.10, 0.05, 0.185}, 0.058, 0.05, 0.05},  // hind foot
}};
const Limb paw{{0.23, 0.05, 0.10}, {0.315, 0.045, 0.10}, 0.05, 0.042, 0.03};

/// Approximate signed distance to an ellipsoid (Quilez, "Ellipsoid - SDF").
double distance_to(const Part& part, const Vec3& x) {
  const Vec3 inside = (x - part.centre).cwiseQuotient(part.radii);
  const double level = inside.norm();
  const double slope = inside.cwiseQuotient(part.radii).norm();
  return slope > 0 ? level * (level - 1) / slope : -part.radii.minCoeff();
}

double distance_to(const Limb& limb, const Vec3& x) {
  const Vec3 along = limb.to - limb.from;
  const double t = std::clamp((x - limb.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (x - limb.from - t * along).norm() - (limb.radius + t * (limb.end - limb.radius));
}

/// Smooth minimum: rounded where the two differ by less than `melt`.
double melted(double a, double b, double melt) {
  if (!(melt > 0)) return std::min(a, b);
  const double overlap = std::max(melt - std::abs(a - b), 0.0) / melt;
  return std::min(a, b) - 0.25 * melt * overlap * overlap;
}

constexpr double height = 1.0035, lowest = -0.0133;  // m, of the model as written above

}  // namespace

double bunny_distance(const Vec3& position) {
  const Vec3 x(height * position.x(), height * position.y() + lowest, height * std::abs(position.z()));
  double distance = distance_to(parts[0], x);
  for (std::size_t k = 1; k < parts.size(); ++k)
    distance = melted(distance, distance_to(parts[k], x), parts[k].melt);
  for (const Limb& limb : limbs) distance = melted(distance, distance_to(limb, x), limb.melt);
  distance = melted(distance, distance_to(paw, x), paw.melt);
  return distance / height;
}

TriangleMesh make_bunny(double cell) {
  const Eigen::AlignedBox3d bounds(Vec3(-0.53, -0.03, -0.35), Vec3(0.51, 1.03, 0.35));
  return surface_nets(bunny_distance, bounds, cell);
}

}  // namespace cloth
