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
  /// Both stay the caller's and must outlive this.
  PairSearch(const Surface& cloth, const std::vector<ObstacleBody>& bodies, bool with_itself);

  /// `reach` in m is added to obstacles on all sides; `particles`, a box for each, are taken as they are.
  /// Pairs come in ascending order, each once. Features of the cloth that share a particle are no pair.
  void find(const std::vector<Bounds>& particles, const std::vector<Passage>& passages, double reach,
            std::vector<FeaturePair>& pairs);

 private:
  class Step;

  const Surface& cloth_;
  const std::vector<ObstacleBody>& bodies_;
  bool with_itself_;
  std::vector<BoxTree> mesh_trees_;  ///< of each body; empty unless it is a mesh
  BoxTree cloth_tree_;
  std::vector<Bounds> faces_;
  std::vector<BoxPair> overlaps_;
};

}  // namespace cloth
