// Broad phase: the pairs of features that may collide within a round. Particles are bounded by capsules,
// which they do not leave until the next search, and obstacles' features by boxes around their whole paths,
// so that no pair is missed at any speed.
#pragma once

#include "contact/feature_pairs.h"
#include "contact/slab.h"
#include "geometry/box_tree.h"
#include "geometry/rounded_box.h"

namespace cloth {

class WorkerTeam;

/// Swept bounds of the particles, and the distances up to which pairs count.
struct SweptBounds {
  std::vector<Capsule> particles{};
  double reach = 0;      ///< m, between cloth and obstacles
  double own_reach = 0;  ///< m, of the cloth from itself
};

/// Builds hierarchies of bounding boxes at construction, where a scene needs them: of meshes, and of the
/// cloth as it starts.
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
  class Step;

  template <class Part, class Fill>
  void in_parts(std::size_t count, std::size_t least, std::vector<std::vector<Part>>& parts,
                std::vector<Part>& whole, const Fill& fill);
  void find_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths);
  template <class Regions>
  void bound_faces(const Regions& particles, double reach);

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  bool with_itself_, needs_trees_ = false;
  double skin_;
  WorkerTeam* team_ = nullptr;
  std::vector<std::vector<Slab>> mesh_faces_;  ///< of each body's triangles
  std::vector<std::vector<RoundedBox>> mesh_boxes_;
  std::vector<std::vector<Bounds>> mesh_edges_;  ///< of each body
  std::vector<BoxTree> mesh_trees_;              ///< of each body; empty unless it is a mesh
  BoxTree cloth_tree_;
  std::vector<Bounds> particles_, faces_, seen_;
  std::vector<Capsule> capsules_;
  std::vector<Ball> balls_;
  std::vector<Slab> own_faces_;
  std::vector<RoundedBox> own_boxes_;  ///< of these
  std::vector<Bounds> own_edges_;
  std::vector<std::vector<FeaturePair>> pair_parts_{1};  ///< of each thread
  std::vector<std::vector<BoxPair>> overlap_parts_{1};

  std::vector<Bounds> cached_;  ///< of the particles, for which the overlaps hold
  std::vector<Pose> cached_poses_;
  double cached_reach_ = 0;
  std::vector<BoxPair> own_overlaps_;  ///< of faces of the cloth
  std::vector<std::vector<BoxPair>>
      mesh_overlaps_;  ///< of each body: a face of the cloth and one of the mesh
};

}  // namespace cloth
