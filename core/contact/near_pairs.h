// Broad phase: the pairs of features that may collide within a round. Particles are bounded by capsules,
// which they do not leave until the next search, and seen from obstacles for the whole of their paths, so
// that no pair is missed at any speed.
#pragma once

#include <optional>
#include <vector>

#include "contact/feature_pairs.h"
#include "contact/region_overlaps.h"
#include "contact/regions.h"

namespace cloth {

class WorkerTeam;

/// Swept bounds of the particles, and the distances up to which pairs count.
struct SweptBounds {
  Vec3Field from{}, to{};        ///< m, of the particles' capsules
  std::vector<double> radius{};  ///< m
  double reach = 0;              ///< m, between cloth and obstacles
  double own_reach = 0;          ///< m, of the cloth from itself

  std::size_t size() const { return radius.size(); }
  Capsule operator[](std::size_t i) const { return {from[i], to[i], radius[i]}; }
};

class PairSearch {
 public:
  /// `cloth` and `bodies` must outlive this. `start`: in m, of the particles. `skin`: m, see RegionOverlaps.
  PairSearch(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
             bool with_itself, double skin);

  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team) { team_ = team; }

  /// Every pair once; pairs and their order depend on the arguments only, these and the constructor's.
  /// Features of the cloth that share a particle are no pair.
  void find(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths,
            std::vector<FeaturePair>& pairs);

  /// Levels of a body's hierarchy, or with `FeaturePair::cloth_itself` of the cloth's; 0 where there is none.
  int hierarchy_depth(int body) const;
  /// Appends its boxes `level` below the root, for drawing: of a mesh as the scene has it, of the cloth
  /// around these positions, grown by `reach`, in m. Changes no pair of a later search.
  void append_boxes(int body, int level, const Vec3Field& position, double reach, std::vector<Bounds>& boxes);

 private:
  class Step;

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  double skin_;
  WorkerTeam* team_ = nullptr;
  std::optional<RegionOverlaps> own_;
  std::vector<std::optional<RegionOverlaps>> meshes_;  ///< of each body
  std::vector<Bounds> particles_;                      ///< of this search
  std::vector<Bounds> seen_;                           ///< scratch
  std::vector<RoundedRegion> near_;                    ///< scratch
};

}  // namespace cloth
