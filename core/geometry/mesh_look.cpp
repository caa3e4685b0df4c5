#include "geometry/mesh_look.h"

#include <cmath>

namespace cloth {
namespace {

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(0, 0, 0);
}

/// Of the plane that the triangles lie in best.
Vec3 best_normal(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  Eigen::AlignedBox3d bounds;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 part = mesh.area_normal(t);
    sum += part, area += part.norm();
  }
  if (sum.norm() > 0.05 * area) return sum.normalized();
  for (const Vec3& vertex : mesh.vertices) bounds.extend(vertex);
  int shortest = 0;
  bounds.sizes().minCoeff(&shortest);
  return Vec3::Unit(shortest);
}

}  // namespace

std::vector<Vec3> corner_normals(const TriangleMesh& mesh) {
  constexpr double most = 0.766;  // cos 40 degrees
  std::vector<Vec3> sum(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 area = mesh.area_normal(t);
    for (const int corner : t) sum[at(corner)] += area;
  }
  std::vector<Vec3> normals;
  normals.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 own = unit(mesh.area_normal(t));
    for (const int corner : t) {
      const Vec3 smooth = unit(sum[at(corner)]);
      normals.push_back(smooth.dot(own) >= most ? smooth : own);
    }
  }
  return normals;
}

FlatPattern flat_pattern(const TriangleMesh& mesh) {
  const Vec3 normal = best_normal(mesh);
  const Vec3 hint = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 u = (hint - hint.dot(normal) * normal).normalized(), v = normal.cross(u);
  FlatPattern pattern;
  Eigen::AlignedBox2d bounds;
  for (const Vec3& vertex : mesh.vertices) {
    pattern.at.emplace_back(u.dot(vertex), v.dot(vertex));
    bounds.extend(pattern.at.back());
  }
  if (bounds.isEmpty()) return pattern;
  pattern.size = bounds.sizes();
  for (Eigen::Vector2d& at : pattern.at) at -= bounds.min();
  return pattern;
}

}  // namespace cloth
