#include "contact/feature_regions.h"

#include <algorithm>

#include "kernels/in_shares.h"

namespace cloth {

void spread(const Surface& surface, OfFeatures<std::vector<Bounds>>& boxes) {
  const std::vector<Bounds>& vertices = boxes[Feature::vertex];
  boxes[Feature::edge].clear(), boxes[Feature::face].clear();
  for (const auto& [a, b] : surface.edges)
    boxes[Feature::edge].push_back(joined(vertices[at(a)], vertices[at(b)]));
  for (const auto& [a, b, c] : surface.triangles)
    boxes[Feature::face].push_back(joined(joined(vertices[at(a)], vertices[at(b)]), vertices[at(c)]));
}

CoarseRegion region_of(const Surface& surface, Feature feature, int index,
                       std::span<const CoarseRegion> vertices) {
  return with_vertices_of(surface, feature, index, [&](const auto& all) {
    CoarseRegion region = vertices[at(all[0])];
    for (std::size_t k = 1; k < all.size(); ++k) region.add(vertices[at(all[k])]);
    return region;
  });
}

void fill(std::vector<EightRegions>& regions, const Surface& surface, Feature feature,
          std::span<const int> order, std::span<const CoarseRegion> vertices, WorkerTeam* team) {
  constexpr std::size_t eight = EightRegions::count, least_eights = 32;
  regions.resize((order.size() + eight - 1) / eight);
  in_shares(team, regions.size(), least_eights, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t place = eight * begin; place < std::min(eight * end, order.size()); ++place)
      regions[place / eight].set(place % eight, region_of(surface, feature, order[place], vertices));
  });
}

PlacesAtVertices::PlacesAtVertices(std::size_t vertices, const Surface& surface, Feature feature,
                                   std::span<const int> order)
    : first_(vertices + 1) {
  const auto for_each = [&](const auto& visit) {
    for (std::size_t place = 0; place < order.size(); ++place)
      with_vertices_of(surface, feature, order[place], [&](const auto& all) {
        for (const int vertex : all) visit(at(vertex), static_cast<int>(place));
      });
  };
  for_each([&](std::size_t vertex, int) { ++first_[vertex + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
  places_.resize(at(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for_each([&](std::size_t vertex, int place) { places_[at(next[vertex]++)] = place; });
}

std::span<const int> PlacesAtVertices::of(int vertex) const {
  return std::span(places_).subspan(at(first_[at(vertex)]), at(first_[at(vertex) + 1] - first_[at(vertex)]));
}

}  // namespace cloth
