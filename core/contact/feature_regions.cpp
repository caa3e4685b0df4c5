#include "contact/feature_regions.h"

#include "geometry/at.h"

namespace cloth {

void spread(const Surface& surface, OfFeatures<std::vector<Bounds>>& boxes) {
  const std::vector<Bounds>& vertices = boxes[Feature::vertex];
  boxes[Feature::edge].clear(), boxes[Feature::face].clear();
  for (const auto& [a, b] : surface.edges)
    boxes[Feature::edge].push_back(joined(vertices[at(a)], vertices[at(b)]));
  for (const auto& [a, b, c] : surface.triangles)
    boxes[Feature::face].push_back(joined(joined(vertices[at(a)], vertices[at(b)]), vertices[at(c)]));
}

RoundedRegion region_of(const Surface& surface, Feature feature, int index,
                        std::span<const RoundedRegion> vertices) {
  const auto joined = [&](const auto& all) {
    RoundedRegion region = vertices[at(all[0])];
    for (std::size_t k = 1; k < all.size(); ++k) region.add(vertices[at(all[k])]);
    return region;
  };
  if (feature == Feature::vertex) return vertices[at(index)];
  return feature == Feature::edge ? joined(surface.edges[at(index)]) : joined(surface.triangles[at(index)]);
}

void fill(std::vector<EightRegions>& regions, const Surface& surface, Feature feature,
          std::span<const int> order, std::span<const RoundedRegion> vertices) {
  constexpr std::size_t eight = EightBoxes::count;
  regions.resize((order.size() + eight - 1) / eight);
  for (std::size_t place = 0; place < order.size(); ++place)
    regions[place / eight].set(place % eight, region_of(surface, feature, order[place], vertices));
}

}  // namespace cloth
