// The features of a surface, and their boxes and coarse regions, from those of its vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/coarse_regions.h"
#include "contact/surface.h"
#include "geometry/at.h"
#include "geometry/bounds.h"

namespace cloth {

class WorkerTeam;

/// What a cloth and a mesh are made of.
enum class Feature : std::uint8_t { vertex, edge, face };

/// One for each Feature.
template <class T>
class OfFeatures {
 public:
  T& operator[](Feature feature) { return all_[static_cast<std::size_t>(feature)]; }
  const T& operator[](Feature feature) const { return all_[static_cast<std::size_t>(feature)]; }

 private:
  std::array<T, 3> all_;
};

/// Calls with_vertices(vertices) for a feature of the surface.
template <class WithVertices>
auto with_vertices_of(const Surface& surface, Feature feature, int index, const WithVertices& with_vertices) {
  if (feature == Feature::vertex) return with_vertices(std::array{index});
  if (feature == Feature::edge) return with_vertices(surface.edges[at(index)]);
  return with_vertices(surface.triangles[at(index)]);
}

/// From the boxes of the vertices to those of edges and faces.
void spread(const Surface& surface, OfFeatures<std::vector<Bounds>>& boxes);

/// `vertices`: the regions of all.
CoarseRegion region_of(const Surface& surface, Feature feature, int index,
                       std::span<const CoarseRegion> vertices);

/// Those of features in the given order, eight by eight. `team`: null is one thread.
void fill(std::vector<EightRegions>& regions, const Surface& surface, Feature feature,
          std::span<const int> order, std::span<const CoarseRegion> vertices, WorkerTeam* team);

/// Places, in an order of features, of those that have a vertex in common.
class PlacesAtVertices {
 public:
  PlacesAtVertices() = default;
  PlacesAtVertices(std::size_t vertices, const Surface& surface, Feature feature, std::span<const int> order);

  std::span<const int> of(int vertex) const;

 private:
  std::vector<int> first_;  ///< of each vertex, its offset in places_; and the end
  std::vector<int> places_;
};

}  // namespace cloth
