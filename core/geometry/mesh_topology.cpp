#include "geometry/mesh_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace cloth {
namespace {

/// An edge as one triangle has it: its ends in ascending order, whether it runs that way, the third corner.
struct Side {
  int low, high, opposite;
  bool ascending;
};

VertexPair pair_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

std::vector<Side> sides_of(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t[(k + 2) % 3], a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return std::tuple(p.low, p.high, p.opposite, p.ascending) <
           std::tuple(q.low, q.high, q.opposite, q.ascending);
  });
  return sides;
}

bool is_same_place(const Vec3& a, const Vec3& b) {
  return a == b;  // -0 and 0 are the same place
}

bool is_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// For each vertex the first at the same place.
std::vector<int> first_at_same_place(const std::vector<Vec3>& vertices) {
  std::vector<int> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int i) -> const Vec3& { return vertices[static_cast<std::size_t>(i)]; };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return is_before(at(i), at(j)); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && is_same_place(at(order[k]), at(order[k - 1]));
    first[static_cast<std::size_t>(order[k])] =
        same ? first[static_cast<std::size_t>(order[k - 1])] : order[k];
  }
  return first;
}

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
  const auto at = [&](std::size_t k) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  constexpr double least_sine = 1e-12;
  const Vec3 a = at(1) - at(0), b = at(2) - at(0);
  return a.cross(b).norm() > least_sine * a.norm() * b.norm();
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

MeshTopology topology_of(const TriangleMesh& mesh) {
  MeshTopology topology;
  const std::vector<Side> sides = sides_of(mesh);
  std::size_t crowded = 0, unlike = 0;
  for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
    while (end < sides.size() && sides[end].low == sides[k].low && sides[end].high == sides[k].high) ++end;
    topology.edges.push_back({sides[k].low, sides[k].high});
    const std::size_t triangles = end - k;
    if (triangles == 1) ++topology.open_edges;
    if (triangles > 2) ++crowded;
    if (triangles == 2 && sides[k].ascending == sides[k + 1].ascending) ++unlike;
    for (std::size_t i = k; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j)
        if (sides[i].opposite != sides[j].opposite)
          topology.hinges.push_back(pair_of(sides[i].opposite, sides[j].opposite));
  }
  std::sort(topology.hinges.begin(), topology.hinges.end());
  topology.hinges.erase(std::unique(topology.hinges.begin(), topology.hinges.end()), topology.hinges.end());
  if (crowded > 0)
    topology.notices.push_back(counted(crowded, "edge belongs", "edges belong") +
                               " to more than two triangles");
  if (unlike > 0)
    topology.notices.push_back("triangles on both sides of " + counted(unlike, "edge", "edges") +
                               " face opposite ways");
  return topology;
}

CleanMesh cleaned(const TriangleMesh& mesh) {
  CleanMesh clean;
  const std::vector<int> first = first_at_same_place(mesh.vertices);
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<Triangle> kept;
  for (Triangle t : mesh.triangles) {
    for (int& corner : t) corner = first[static_cast<std::size_t>(corner)];
    if (!has_area(mesh, t)) continue;
    kept.push_back(t);
    for (const int corner : t) number[static_cast<std::size_t>(corner)] = 0;
  }
  std::size_t welded = 0, unused = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == 0) {
      number[i] = static_cast<int>(clean.mesh.vertices.size());
      clean.mesh.vertices.push_back(mesh.vertices[i]);
    } else if (first[i] != static_cast<int>(i)) {
      ++welded;
    } else {
      ++unused;
    }
  }
  for (Triangle t : kept) {
    for (int& corner : t) corner = number[static_cast<std::size_t>(corner)];
    clean.mesh.triangles.push_back(t);
  }
  const char* renumbered = "; vertices after it have lower numbers than in the file";
  const std::size_t flat = mesh.triangles.size() - kept.size();
  if (welded > 0)
    clean.notices.push_back(counted(welded, "vertex is", "vertices are") +
                            " at the place of another and one with it" + renumbered);
  if (flat > 0)
    clean.notices.push_back(counted(flat, "triangle has", "triangles have") + " no area and left out");
  if (unused > 0)
    clean.notices.push_back(counted(unused, "vertex belongs", "vertices belong") +
                            " to no triangle and left out" + renumbered);
  return clean;
}

}  // namespace cloth
