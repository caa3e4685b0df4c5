#include "support/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "support/box_sweep.h"
#include "support/exact_sign.h"

namespace cloth::test {
namespace {

template <class... Points>
Extent extent_of(const Points&... points) {
  constexpr double none = std::numeric_limits<double>::infinity();
  Extent extent{{none, none, none}, {-none, -none, -none}};
  const auto add = [&](const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = p[static_cast<Eigen::Index>(k)];
      extent.least[k] = std::min(extent.least[k], x), extent.most[k] = std::max(extent.most[k], x);
    }
  };
  (add(points), ...);
  return extent;
}

using Edge = std::array<int, 2>;

/// A mesh with all that the loops ask for again and again; or of it what is not apart from `within`.
struct Features {
  explicit Features(const TriangleMesh& given, const std::optional<Extent>& within = {}) : mesh(given) {
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      const Triangle& t = mesh.triangles[k];
      const Extent extent = extent_of(at(t[0]), at(t[1]), at(t[2]));
      if (within && apart(extent, *within)) continue;
      triangles.push_back(k);
      triangle_extents.push_back(extent);
      for (std::size_t i = 0; i < 3; ++i)
        edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (const Edge& e : edges) edge_extents.push_back(extent_of(at(e[0]), at(e[1])));
  }

  const Vec3& at(int i) const { return mesh.vertices[static_cast<std::size_t>(i)]; }

  bool meets(const Vec3& p, const Vec3& q, const Triangle& t) const {
    return segment_meets_triangle(p, q, at(t[0]), at(t[1]), at(t[2]));
  }

  const TriangleMesh& mesh;
  std::vector<std::size_t> triangles;  ///< their indices in the mesh
  std::vector<Extent> triangle_extents;
  std::vector<Edge> edges;
  std::vector<Extent> edge_extents;
};

void add(Count& count, const std::string& place) {
  if (count.number++ == 0) count.first = place;
}

std::string edge_name(const Edge& e) {
  return "edge " + std::to_string(e[0]) + "-" + std::to_string(e[1]);
}

std::string triangle_name(std::size_t k) {
  return "triangle " + std::to_string(k);
}

std::vector<IndexPair> overlaps(Search search, const std::vector<Extent>& a, const std::vector<Extent>& b) {
  return search == Search::sweep ? overlaps_by_sweep(a, b) : overlaps_of_all_pairs(a, b);
}

void count_edges_through(const Features& edges, const Features& triangles, const std::string& of_edges,
                         const std::string& of_triangles, Search search, Count& count) {
  for (const auto& [e, t] : overlaps(search, edges.edge_extents, triangles.triangle_extents)) {
    const Edge& edge = edges.edges[e];
    const std::size_t triangle = triangles.triangles[t];
    if (triangles.meets(edges.at(edge[0]), edges.at(edge[1]), triangles.mesh.triangles[triangle]))
      add(count, edge_name(edge) + of_edges + " and " + triangle_name(triangle) + of_triangles);
  }
}

int shared_vertices(const Triangle& s, const Triangle& t) {
  return static_cast<int>(
      std::count_if(s.begin(), s.end(), [&](int i) { return std::find(t.begin(), t.end(), i) != t.end(); }));
}

/// An edge of `s`, other than those that end in a vertex of `t`, through `t`.
bool passes_through(const Features& cloth, const Triangle& s, const Triangle& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = s[k], to = s[(k + 1) % 3];
    if (std::find(t.begin(), t.end(), from) != t.end() || std::find(t.begin(), t.end(), to) != t.end())
      continue;
    if (cloth.meets(cloth.at(from), cloth.at(to), t)) return true;
  }
  return false;
}

/// Along which axis the points can be projected without falling onto a line; -1 where they lie on one.
int axis_of_sight(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis)
    if (turn(a, b, c, axis) != 0) return axis;
  return -1;
}

/// Whether `point`, on the line through a and b, lies between them.
bool between(const Vec3& a, const Vec3& b, const Vec3& point) {
  return !apart(extent_of(a, b), extent_of(point));
}

/// Segments in one plane, as seen along an axis that does not lie in it.
bool planar_segments_meet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int axis) {
  const int c_side = turn(a, b, c, axis), d_side = turn(a, b, d, axis);
  const int a_side = turn(c, d, a, axis), b_side = turn(c, d, b, axis);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d)) ||
         (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b));
}

bool planar_triangle_holds(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point, int axis) {
  const int ab = turn(a, b, point, axis), bc = turn(b, c, point, axis), ca = turn(c, a, point, axis);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

using Long3 = std::array<long double, 3>;

Long3 minus(const Vec3& a, const Vec3& b) {
  return {static_cast<long double>(a.x()) - b.x(), static_cast<long double>(a.y()) - b.y(),
          static_cast<long double>(a.z()) - b.z()};
}

long double dot(const Long3& a, const Long3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

long double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Long3 along = minus(b, a), to_p = minus(p, a), from_b = minus(p, b);
  const long double length = std::sqrt(dot(along, along));
  if (!(dot(to_p, along) > 0)) return std::sqrt(dot(to_p, to_p));
  if (!(dot(from_b, along) < 0)) return std::sqrt(dot(from_b, from_b));
  const Long3 area = cross(along, to_p);
  return std::sqrt(dot(area, area)) / length;
}

/// The height over the plane where the foot is inside, seen from each edge; else the nearest edge.
long double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Long3 normal = cross(minus(b, a), minus(c, a));
  const auto inward = [&](const Vec3& from, const Vec3& to) {
    return dot(cross(normal, minus(to, from)), minus(p, from)) > 0;
  };
  if (inward(a, b) && inward(b, c) && inward(c, a))
    return std::abs(dot(normal, minus(p, a))) / std::sqrt(dot(normal, normal));
  return std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
}

}  // namespace

TriangleMesh grid_triangles(int rows, int columns, const Vec3Field& position) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < position.size(); ++i) mesh.vertices.push_back(position[i]);
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column, b = a + 1, d = a + columns, c = d + 1;
      mesh.triangles.push_back({a, d, c});
      mesh.triangles.push_back({a, c, b});
    }
  }
  return mesh;
}

TriangleMesh box_triangles(const Vec3& center, const Eigen::Matrix3d& axes, const Vec3& half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    const Vec3 side((k & 1) ? 1 : -1, (k & 2) ? 1 : -1, (k & 4) ? 1 : -1);
    mesh.vertices.emplace_back(center + axes * side.cwiseProduct(half));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

bool segments_meet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (side_of_plane(a, b, c, d) != 0 || apart(extent_of(a, b), extent_of(c, d))) return false;
  for (const int axis : {axis_of_sight(a, b, c), axis_of_sight(a, b, d), axis_of_sight(c, d, a)})
    if (axis >= 0) return planar_segments_meet(a, b, c, d, axis);
  return true;  // on one line, where extents that meet are segments that do
}

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int p_side = side_of_plane(a, b, c, p), q_side = side_of_plane(a, b, c, q);
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) {
    if (segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a)) return true;
    const int axis = axis_of_sight(a, b, c);
    return axis >= 0 && planar_triangle_holds(a, b, c, p, axis);
  }
  const int ab = side_of_plane(p, q, a, b), bc = side_of_plane(p, q, b, c), ca = side_of_plane(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

Count crossings(const TriangleMesh& cloth, const TriangleMesh& obstacle, Search search) {
  const Features soft(cloth);
  std::optional<Extent> reach;
  if (search == Search::sweep) reach = hull_of(soft.triangle_extents);
  const Features hard(obstacle, reach);
  Count count;
  count_edges_through(soft, hard, " of the cloth", " of the obstacle", search, count);
  count_edges_through(hard, soft, " of the obstacle", " of the cloth", search, count);
  return count;
}

Count self_crossings(const TriangleMesh& cloth, Search search) {
  const Features features(cloth);
  Count count;
  for (const auto& [i, j] : overlaps(search, features.triangle_extents, features.triangle_extents)) {
    if (j <= i) continue;
    const Triangle &s = cloth.triangles[i], &t = cloth.triangles[j];
    if (shared_vertices(s, t) > 1) continue;
    if (passes_through(features, s, t) || passes_through(features, t, s))
      add(count, "triangles " + std::to_string(i) + " and " + std::to_string(j));
  }
  return count;
}

Count triangles_in_sphere(const TriangleMesh& cloth, const Vec3& center, double radius) {
  Count count;
  for (std::size_t k = 0; k < cloth.triangles.size(); ++k) {
    const auto at = [&](std::size_t i) {
      return cloth.vertices[static_cast<std::size_t>(cloth.triangles[k][i])];
    };
    if (triangle_distance(center, at(0), at(1), at(2)) <= radius) add(count, triangle_name(k));
  }
  return count;
}

Count triangles_in_solid(const TriangleMesh& cloth, const TriangleMesh& closed) {
  const Features soft(cloth), hard(closed);
  Count count;
  for (std::size_t s = 0; s < cloth.triangles.size(); ++s) {
    const Triangle& t = cloth.triangles[s];
    bool found = winding_number(closed, soft.at(t[0])) != 0;
    for (std::size_t k = 0; k < hard.triangle_extents.size() && !found; ++k) {
      if (apart(soft.triangle_extents[s], hard.triangle_extents[k])) continue;
      const Triangle& face = closed.triangles[k];
      for (std::size_t i = 0; i < 3 && !found; ++i)
        found = hard.meets(soft.at(t[i]), soft.at(t[(i + 1) % 3]), face) ||
                soft.meets(hard.at(face[i]), hard.at(face[(i + 1) % 3]), t);
    }
    if (found) add(count, triangle_name(s));
  }
  return count;
}

Count vertices_below_plane(const TriangleMesh& cloth, const Vec3& point, const Vec3& normal) {
  Count count;
  for (std::size_t i = 0; i < cloth.vertices.size(); ++i)
    if (side_of_half_space(normal, point, cloth.vertices[i]) <= 0) add(count, "vertex " + std::to_string(i));
  return count;
}

int winding_number(const TriangleMesh& mesh, const Vec3& point, int axis) {
  // Seen against the ray, each triangle that covers the point counts. An edge covers the points on it to one
  // of its two sides, the same for both of its triangles: as if the point were moved by something smaller
  // than all numbers.
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  int number = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t i) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[i % 3])];
    };
    if (std::max({at(0)[axis], at(1)[axis], at(2)[axis]}) < point[axis]) continue;
    if (std::max({at(0)[x], at(1)[x], at(2)[x]}) < point[x]) continue;
    int around = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &from = at(k), &to = at(k + 1);
      if (from[y] <= point[y] && to[y] > point[y]) around += turn(from, to, point, axis) > 0 ? 1 : 0;
      if (to[y] <= point[y] && from[y] > point[y]) around -= turn(from, to, point, axis) < 0 ? 1 : 0;
    }
    if (around == 0) continue;
    const int side = side_of_plane(at(0), at(1), at(2), point);
    if (side * around < 0) number += around;  // the triangle lies further along the ray
  }
  return number;
}

Count vertices_inside(const TriangleMesh& cloth, const TriangleMesh& closed) {
  Count count;
  for (std::size_t i = 0; i < cloth.vertices.size(); ++i)
    if (winding_number(closed, cloth.vertices[i]) != 0) add(count, "vertex " + std::to_string(i));
  return count;
}

Count ways_through(const TriangleMesh& before, const TriangleMesh& after, const TriangleMesh& mesh) {
  const Features features(mesh);
  Count count;
  for (std::size_t i = 0; i < before.vertices.size(); ++i) {
    const Vec3 &from = before.vertices[i], &to = after.vertices[i];
    const Extent extent = extent_of(from, to);
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      if (apart(extent, features.triangle_extents[k]) || !features.meets(from, to, mesh.triangles[k]))
        continue;
      add(count, "vertex " + std::to_string(i) + " and " + triangle_name(k));
      break;
    }
  }
  return count;
}

}  // namespace cloth::test
