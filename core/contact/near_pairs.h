// Which features can meet within a step: those whose boxes overlap. A particle stays in its box until the
// pairs are found anew, and the box of an obstacle's feature holds its whole way, so that no pair is missed
// at any speed.
#pragma once

#include "contact/feature_pairs.h"
#include "geometry/box_tree.h"

namespace cloth {

/// Keeps hierarchies where a scene needs them: of meshes from the start, of the cloth from the first search
/// on.
class PairSearch {
 public:
  /// Both stay the caller's and must outlive this. What hierarchies found serves again while no particle
  /// leaves its box by more than `skin`, in m.
  PairSearch(const Surface& cloth, const std::vector<ObstacleBody>& bodies, bool with_itself, double skin);

  /// `reach` in m is added to obstacles on all sides; `particles`, a box for each, are taken as they are.
  /// Every pair comes once; pairs and their order follow from the arguments alone. Features of the cloth that
  /// share a particle are no pair.
  void find(const std::vector<Bounds>& particles, const std::vector<Passage>& passages, double reach,
            std::vector<FeaturePair>& pairs);

  /// Levels of a body's hierarchy, or with `FeaturePair::cloth_itself` of the cloth's; 0 where there is none.
  int hierarchy_depth(int body) const;
  /// Appends its boxes `level` below the root, for drawing: of a mesh as the scene has it, of the cloth
  /// around these positions, grown by `reach`, in m. Changes no pair of a later search.
  void append_boxes(int body, int level, const Vec3Field& position, double reach, std::vector<Bounds>& boxes);

 private:
  class Step;

  void look_in_trees(const std::vector<Bounds>& particles, const std::vector<Passage>& passages,
                     double reach);
  void refit_cloth();
  void find_faces(const std::vector<Bounds>& particles);

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  bool with_itself_, needs_trees_ = false;
  double skin_;
  std::vector<std::vector<Bounds>> mesh_boxes_;  ///< of each body's triangles
  std::vector<BoxTree> mesh_trees_;              ///< of each body; empty unless it is a mesh
  BoxTree cloth_tree_;
  std::vector<Bounds> faces_, seen_;

  std::vector<Bounds> kept_;  ///< of the particles, for which the overlaps hold
  std::vector<Pose> kept_poses_;
  double kept_reach_ = 0;
  std::vector<BoxPair> own_overlaps_;  ///< of faces of the cloth
  std::vector<std::vector<BoxPair>>
      mesh_overlaps_;  ///< of each body: a face of the cloth and one of the mesh
};

}  // namespace cloth
