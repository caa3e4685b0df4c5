// Pairs of features whose regions overlap: those of the cloth with those of a mesh or of the cloth itself.
// What a hierarchy of bounding boxes finds for regions grown by a skin is kept while particles do not leave
// their own (a neighbour list, Verlet 1967); of a mesh, whose features stay, it is found anew for those
// features of the cloth alone whose particles did.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/coarse_numbers.h"
#include "contact/feature_pairs.h"
#include "contact/feature_regions.h"
#include "contact/region_kernels.h"
#include "contact/regions.h"
#include "geometry/box_tree.h"

namespace cloth {

class WorkerTeam;

class RegionOverlaps {
 public:
  /// Of the cloth with itself, which starts there, in m. `cloth` must outlive this, as for the other
  /// constructor. Both throw std::length_error for more than 134 million features of a kind on the far side.
  RegionOverlaps(const Surface& cloth, const Vec3Field& start);
  /// With an obstacle's mesh, as the scene has it.
  RegionOverlaps(const Surface& cloth, int obstacle, const ObstacleBody& mesh);

  /// Appends every pair once. Pairs and their order depend on the regions only, not on skin, team or earlier
  /// searches; features of the cloth that share a particle are no pair. `particles`: their regions in the
  /// mesh's coordinates, grown by the reach; of the cloth itself by half of it. `skin`: m in these
  /// coordinates. `team`: null is one thread.
  void find(std::span<const RoundedRegion> particles, double skin, WorkerTeam* team,
            std::vector<FeaturePair>& pairs);

  /// Of faces, for drawing: boxes of the mesh, or of the cloth in some search.
  const BoxTree& hierarchy() const { return trees_[Feature::face]; }
  /// Only of the cloth itself: its boxes around these positions, in m, grown by `reach`, until the next
  /// search.
  void refit_hierarchy(const Vec3Field& position, double reach);

 private:
  /// Of features, in the order of their hierarchy.
  using Regions = std::vector<EightRegions>;
  /// Features of both sides that can be pairs of one kind.
  struct Meeting {
    PairKind kind;
    std::vector<RegionOverlap> overlaps{};  ///< by query, a feature of the near side

    Feature near() const;
    Feature far() const;
  };
  struct alignas(64) Part {  ///< of one share: what threads write lies in cache lines of their own
    std::vector<FeaturePair> pairs;
    std::vector<RegionOverlap> overlaps, around, left;
    std::vector<std::uint8_t> no_pairs;  ///< a bit for each place, 0 between two queries
    std::vector<int> places;
  };

  bool is_own() const { return obstacle_ == FeaturePair::cloth_itself; }
  bool keeps_regions(std::span<const RoundedRegion> particles, double skin);
  void take_regions(std::span<const RoundedRegion> particles, WorkerTeam* team);
  void find_own(WorkerTeam* team);
  void find_own_of_eight(const Meeting& meeting, std::size_t first, Part& part,
                         std::vector<RegionOverlap>& overlaps) const;
  void take_own(const Meeting& meeting, int query, const CoarseRegion& region, Part& part,
                std::vector<RegionOverlap>& overlaps) const;
  void find_of_mesh(WorkerTeam* team);
  void take_of_mesh(const Meeting& meeting, int query, Part& part,
                    std::vector<RegionOverlap>& overlaps) const;
  template <class CollectPart>
  void collect(std::size_t items, std::size_t least, Meeting& meeting, WorkerTeam* team,
               const CollectPart& collect_part);
  std::size_t number_of(Feature near) const;
  void take_near(const Meeting& meeting, WorkerTeam* team, std::vector<FeaturePair>& pairs);

  const Surface& cloth_;
  int obstacle_ = FeaturePair::cloth_itself;
  OfFeatures<BoxTree> trees_;  ///< of the far side: the cloth's has no vertices
  OfFeatures<Regions> regions_;
  OfFeatures<PlacesAtVertices> at_vertices_;  ///< only of the cloth itself
  std::vector<Meeting> meetings_;
  CoarseNumbers numbers_;
  std::vector<RoundedRegion> kept_;  ///< of the particles, for which the overlaps hold
  // Scratch:
  std::vector<char> has_left_;        ///< of the particles
  std::vector<CoarseRegion> coarse_;  ///< of the particles
  OfFeatures<std::vector<Bounds>> boxes_;
  std::vector<RegionOverlap> before_;
  std::vector<Part> parts_;
};

}  // namespace cloth
