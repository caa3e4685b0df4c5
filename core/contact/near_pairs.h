// Broad phase: the pairs of features that may collide within a round. Particles are bounded by capsules,
// which they do not leave until the next search, and seen from obstacles for the whole of their paths, so
// that no pair is missed at any speed.
#pragma once

#include <vector>

#include "contact/feature_pairs.h"
#include "contact/feature_regions.h"
#include "contact/region_kernels.h"
#include "contact/regions.h"
#include "geometry/box_tree.h"

namespace cloth {

class WorkerTeam;

/// Swept bounds of the particles, and the distances up to which pairs count.
struct SweptBounds {
  std::vector<Capsule> particles{};
  double reach = 0;      ///< m, between cloth and obstacles
  double own_reach = 0;  ///< m, of the cloth from itself
};

/// Builds hierarchies of bounding boxes at construction, where a scene needs them: of the edges and faces of
/// the cloth as it starts, and of the vertices, edges and faces of meshes.
class PairSearch {
 public:
  /// `cloth` and `bodies` must outlive this. `start`: in m, of the particles. Overlaps of the hierarchies are
  /// reused while no particle leaves its box by more than `skin`, in m.
  PairSearch(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
             bool with_itself, double skin);

  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team);

  /// Every pair once; pairs and their order depend on the arguments only, these and the constructor's.
  /// Features of the cloth that share a particle are no pair.
  void find(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths,
            std::vector<FeaturePair>& pairs);

  /// Drops the cached overlaps: the reaches have changed.
  void forget() { cached_.clear(); }

  /// Levels of a body's hierarchy, or with `FeaturePair::cloth_itself` of the cloth's; 0 where there is none.
  int hierarchy_depth(int body) const;
  /// Appends its boxes `level` below the root, for drawing: of a mesh as the scene has it, of the cloth
  /// around these positions, grown by `reach`, in m. Changes no pair of a later search.
  void append_boxes(int body, int level, const Vec3Field& position, double reach, std::vector<Bounds>& boxes);

 private:
  /// Of features, in the order of their hierarchy.
  using Regions = std::vector<EightRegions>;
  /// Features of the cloth and of a mesh or of the cloth itself that can be pairs of one kind.
  struct Meeting {
    int obstacle = FeaturePair::cloth_itself;
    PairKind kind = PairKind::edge_edge;
    std::vector<RegionOverlap> overlaps{};  ///< by query

    Feature near() const;
    Feature far() const;
  };
  class Step;

  bool keeps_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths) const;
  void find_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths);
  void find_own_overlaps(double reach);
  void find_mesh_overlaps(Meeting& meeting);
  template <class Collect>
  void collect(std::size_t queries, Meeting& meeting, const Collect& collect_part);
  void take_near(const Meeting& meeting, const Regions& far, std::vector<FeaturePair>& pairs);

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  bool with_itself_;
  double skin_;
  WorkerTeam* team_ = nullptr;
  OfFeatures<BoxTree> own_trees_;                  ///< of edges and faces
  std::vector<OfFeatures<BoxTree>> mesh_trees_;    ///< of each body; empty unless it is a mesh
  std::vector<OfFeatures<Regions>> mesh_regions_;  ///< of each body
  std::vector<Meeting> meetings_;
  std::vector<Bounds> particles_;          ///< of this search
  std::vector<unsigned> outcodes_;         ///< of particles, scratch
  OfFeatures<std::vector<Bounds>> boxes_;  ///< scratch
  std::vector<RoundedRegion> near_;        ///< of the particles, in the coordinates of the far side; grown by
                                           ///< the reach, of the cloth itself by half of it
  OfFeatures<Regions> own_regions_;
  struct Part {  ///< of one share
    std::vector<FeaturePair> pairs;
    std::vector<RegionOverlap> overlaps;
    std::vector<int> places;
  };
  std::vector<Part> parts_{1};

  std::vector<Bounds> cached_;  ///< of the particles, for which the overlaps hold
  std::vector<Pose> cached_poses_;
  double cached_reach_ = 0, cached_own_reach_ = 0;
};

}  // namespace cloth
