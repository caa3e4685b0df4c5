#include "contact/surface.h"

#include <algorithm>

namespace cloth {
namespace {

struct HalfEdge {
  int low, high;  ///< vertices
  int triangle, corner;
  bool operator<(const HalfEdge& other) const {
    return std::array{low, high, triangle, corner} <
           std::array{other.low, other.high, other.triangle, other.corner};
  }
};

std::vector<HalfEdge> half_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[f][static_cast<std::size_t>(k)],
                                           triangles[f][static_cast<std::size_t>((k + 1) % 3)]);
      halves.push_back({low, high, static_cast<int>(f), k});
    }
  std::sort(halves.begin(), halves.end());
  return halves;
}

void add_edges(Surface& surface) {
  surface.edges_of.assign(surface.triangles.size(), {-1, -1, -1});
  for (const HalfEdge& half : half_edges(surface.triangles)) {
    const bool is_new =
        surface.edges.empty() || surface.edges.back() != std::array<int, 2>{half.low, half.high};
    const auto triangle = static_cast<std::size_t>(half.triangle);
    const int beside = surface.triangles[triangle][static_cast<std::size_t>((half.corner + 2) % 3)];
    if (is_new) {
      surface.edges.push_back({half.low, half.high});
      surface.beside_edge.push_back({beside, -1});
      surface.triangle_of_edge.push_back(half.triangle);
      surface.represented[triangle] =
          static_cast<RepresentedFeatures>(surface.represented[triangle] | 1 << (3 + half.corner));
    } else if (surface.beside_edge.back()[1] < 0) {
      surface.beside_edge.back()[1] = beside;
    }
    surface.edges_of[triangle][static_cast<std::size_t>(half.corner)] =
        static_cast<int>(surface.edges.size()) - 1;
  }
}

void add_neighbours(Surface& surface, std::size_t vertices) {
  std::vector<std::vector<int>> lists(vertices);
  for (const auto& [a, b] : surface.edges) {
    lists[static_cast<std::size_t>(a)].push_back(b);
    lists[static_cast<std::size_t>(b)].push_back(a);
  }
  surface.first_neighbour.reserve(vertices + 1);
  for (const std::vector<int>& list : lists) {
    surface.first_neighbour.push_back(static_cast<int>(surface.neighbours.size()));
    surface.neighbours.insert(surface.neighbours.end(), list.begin(), list.end());
  }
  surface.first_neighbour.push_back(static_cast<int>(surface.neighbours.size()));
}

}  // namespace

Surface make_surface(int vertices, std::vector<Triangle> triangles) {
  Surface surface;
  surface.triangles = std::move(triangles);
  surface.represented.assign(surface.triangles.size(), 0);
  surface.triangle_of_vertex.assign(static_cast<std::size_t>(vertices), -1);
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      int& owner = surface.triangle_of_vertex[static_cast<std::size_t>(surface.triangles[f][k])];
      if (owner >= 0) continue;
      owner = static_cast<int>(f);
      surface.represented[f] = static_cast<RepresentedFeatures>(surface.represented[f] | 1 << k);
    }
  add_edges(surface);
  add_neighbours(surface, static_cast<std::size_t>(vertices));
  return surface;
}

}  // namespace cloth
