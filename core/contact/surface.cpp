#include "contact/surface.h"

#include "geometry/mesh_repair.h"

namespace cloth {
namespace {

void add_edges(Surface& surface) {
  surface.edges_of.assign(surface.triangles.size(), {-1, -1, -1});
  for (const HalfEdge& half : half_edges(surface.triangles)) {
    const bool is_new =
        surface.edges.empty() || surface.edges.back() != std::array<int, 2>{half.low, half.high};
    const auto triangle = at(half.triangle);
    const int beside = surface.triangles[triangle][at((half.corner + 2) % 3)];
    if (is_new) {
      surface.edges.push_back({half.low, half.high});
      surface.beside_edge.push_back({beside, -1});
      surface.triangle_of_edge.push_back(half.triangle);
    } else if (surface.beside_edge.back()[1] < 0) {
      surface.beside_edge.back()[1] = beside;
    }
    surface.edges_of[triangle][at(half.corner)] = static_cast<int>(surface.edges.size()) - 1;
  }
}

void add_neighbours(Surface& surface, std::size_t vertices) {
  std::vector<std::vector<int>> lists(vertices);
  for (const auto& [a, b] : surface.edges) {
    lists[at(a)].push_back(b);
    lists[at(b)].push_back(a);
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
  surface.triangle_of_vertex.assign(static_cast<std::size_t>(vertices), -1);
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (const int vertex : surface.triangles[f]) {
      int& owner = surface.triangle_of_vertex[at(vertex)];
      if (owner < 0) owner = static_cast<int>(f);
    }
  add_edges(surface);
  add_neighbours(surface, static_cast<std::size_t>(vertices));
  return surface;
}

}  // namespace cloth
