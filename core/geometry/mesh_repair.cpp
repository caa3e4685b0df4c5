#include "geometry/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace cloth {
namespace {

const Vec3& vertex(const TriangleMesh& mesh, int i) {
  assert(i >= 0 && at(i) < mesh.vertices.size());
  return mesh.vertices[at(i)];
}

bool names_a_vertex_twice(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Vertices that stayed, by the cell of a raster that they lie in: few in each, as they are a tolerance
/// apart.
class KeptVertices {
 public:
  explicit KeptVertices(double tolerance) : tolerance_(tolerance) {}

  /// The first that is near enough, or -1.
  int near(const Vec3& place, const std::vector<Vec3>& kept) const {
    const int reach = tolerance_ > 0 ? 1 : 0;
    int first = -1;
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        for (int k = -reach; k <= reach; ++k) {
          const auto cell = cells_.find(cell_of(place) + Vec3(i, j, k));
          if (cell == cells_.end()) continue;
          for (const int candidate : cell->second) {
            const double distance = (kept[at(candidate)] - place).stableNorm();
            if (distance <= tolerance_ && (first < 0 || candidate < first)) first = candidate;
          }
        }
    return first;
  }

  void add(const Vec3& place, int number) { cells_[cell_of(place)].push_back(number); }

 private:
  struct Hash {
    std::size_t operator()(const Vec3& cell) const {
      std::uint64_t hash = 0;
      for (const double c : cell)  // + 0.0: both zeros are one
        hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U, hash ^= hash >> 29;
      return static_cast<std::size_t>(hash);
    }
  };

  /// Cells are two tolerances wide, so that rounding puts no pair two cells apart.
  Vec3 cell_of(const Vec3& place) const {
    return tolerance_ > 0 ? Vec3((place / (2 * tolerance_)).array().floor()) : place;
  }

  double tolerance_;
  std::unordered_map<Vec3, std::vector<int>, Hash> cells_;
};

/// Counts one kind of fault and keeps its first place.
class Tally {
 public:
  Tally(MeshFault fault, const char* one, const char* many) : one_(one), many_(many) {
    finding_.fault = fault;
  }

  void add(int first, const std::string& place) {
    if (finding_.count++ > 0) return;
    finding_.first = first;
    place_ = place;
  }

  void report(std::vector<MeshFinding>& findings) {
    if (finding_.count == 0) return;
    finding_.message = finding_.count == 1
                           ? fmt::format("1 {}, {}", one_, place_)
                           : fmt::format("{} {}, the first {}", finding_.count, many_, place_);
    findings.push_back(finding_);
  }

 private:
  const char *one_, *many_;
  std::string place_;
  MeshFinding finding_;
};

std::string place_text(const Vec3& place) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", place.x(), place.y(), place.z());
}

std::string between(const TriangleMesh& mesh, const MeshEdge& edge) {
  return fmt::format("between vertices {} and {} near {}", edge.from, edge.to,
                     place_text(0.5 * (vertex(mesh, edge.from) + vertex(mesh, edge.to))));
}

bool degenerate(const TriangleMesh& mesh, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (vertex(mesh, t[(k + 1) % 3]) - vertex(mesh, t[k])).squaredNorm());
  return names_a_vertex_twice(t) || !(0.5 * mesh.area_normal(t).norm() > 1e-12 * longest);
}

}  // namespace

Weld weld(const TriangleMesh& mesh, double tolerance) {
  assert(tolerance >= 0);
  Weld result;
  KeptVertices kept(tolerance);
  result.number.reserve(mesh.vertices.size());
  for (const Vec3& place : mesh.vertices) {
    int number = kept.near(place, result.mesh.vertices);
    if (number < 0) {
      number = static_cast<int>(result.mesh.vertices.size());
      kept.add(place, number);
      result.mesh.vertices.push_back(place);
    }
    result.number.push_back(number);
  }
  result.merged_vertices = static_cast<int>(mesh.vertices.size() - result.mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    Triangle welded;
    for (std::size_t k = 0; k < 3; ++k) welded[k] = result.number[at(t[k])];
    if (names_a_vertex_twice(welded))
      ++result.collapsed_triangles;
    else
      result.mesh.triangles.push_back(welded);
  }
  return result;
}

std::vector<HalfEdge> half_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[f][at(k)], triangles[f][at((k + 1) % 3)]);
      halves.push_back({low, high, static_cast<int>(f), k});
    }
  std::sort(halves.begin(), halves.end());
  return halves;
}

std::vector<MeshEdge> unique_edges(const TriangleMesh& mesh) {
  std::vector<MeshEdge> edges;
  for (const HalfEdge& half : half_edges(mesh.triangles)) {
    const Triangle& t = mesh.triangles[at(half.triangle)];
    if (names_a_vertex_twice(t)) continue;
    if (edges.empty() || edges.back().from != half.low || edges.back().to != half.high)
      edges.push_back({.from = half.low, .to = half.high});
    MeshEdge& edge = edges.back();
    if (edge.triangles < 2) edge.opposite[at(edge.triangles)] = t[at((half.corner + 2) % 3)];
    ++edge.triangles;
    if (t[at(half.corner)] == half.low) ++edge.forward;
  }
  return edges;
}

std::vector<MeshFinding> inspect(const TriangleMesh& mesh) {
  Tally flat(MeshFault::degenerate_triangle, "triangle without area", "triangles without area");
  Tally open(MeshFault::open_edge, "open edge", "open edges");
  Tally winding(MeshFault::inconsistent_winding, "edge whose two triangles face opposite ways",
                "edges whose two triangles face opposite ways");
  Tally crowded(MeshFault::crowded_edge, "edge of more than two triangles",
                "edges of more than two triangles");
  Tally unused(MeshFault::unused_vertex, "vertex of no triangle", "vertices of no triangle");

  std::vector<bool> used(mesh.vertices.size(), false);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[k];
    for (const int i : t) used[at(i)] = true;
    if (!degenerate(mesh, t)) continue;
    flat.add(static_cast<int>(k), fmt::format("triangle {} of vertices {}, {} and {} near {}", k, t[0], t[1],
                                              t[2], place_text(vertex(mesh, t[0]))));
  }
  for (const MeshEdge& edge : unique_edges(mesh)) {
    if (edge.triangles == 1) open.add(edge.from, between(mesh, edge));
    if (edge.triangles == 2 && edge.forward != 1) winding.add(edge.from, between(mesh, edge));
    if (edge.triangles > 2) crowded.add(edge.from, between(mesh, edge));
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i])
      unused.add(static_cast<int>(i), fmt::format("vertex {} at {}", i, place_text(mesh.vertices[i])));

  std::vector<MeshFinding> findings;
  for (Tally* tally : {&flat, &open, &winding, &crowded, &unused}) tally->report(findings);
  return findings;
}

}  // namespace cloth
