// The features of a surface, and their boxes and rounded regions, from those of its vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/surface.h"
#include "geometry/bounds.h"
#include "geometry/eight_extents.h"

namespace cloth {

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

/// From the boxes of the vertices to those of edges and faces.
void spread(const Surface& surface, OfFeatures<std::vector<Bounds>>& boxes);

/// `vertices`: the regions of all.
RoundedRegion region_of(const Surface& surface, Feature feature, int index,
                        std::span<const RoundedRegion> vertices);

/// Those of features in the given order, eight by eight.
void fill(std::vector<EightRegions>& regions, const Surface& surface, Feature feature,
          std::span<const int> order, std::span<const RoundedRegion> vertices);

}  // namespace cloth
