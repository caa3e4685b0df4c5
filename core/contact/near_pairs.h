// Which features can meet within a step: those whose boxes overlap. A particle stays in its box until the
// pairs are found anew, and the box of an obstacle's feature holds its whole way, so that no pair is missed
// at any speed.
#pragma once

#include "contact/feature_pairs.h"

namespace cloth {

using Box = Eigen::AlignedBox3d;

/// `reach` in m is added to obstacles on all sides; `particle_boxes` are taken as they are. Pairs come in
/// ascending order, each once. Features of the cloth that share a particle are no pair.
void find_near_pairs(const Surface& cloth, const std::vector<Box>& particle_boxes,
                     const std::vector<ObstacleBody>& bodies, const std::vector<Passage>& passages,
                     double reach, bool with_itself, std::vector<FeaturePair>& pairs);

}  // namespace cloth
