// Obstacles, motions and crumpled sheets at random, for tests of the parts of continuous contact.
#pragma once

#include "contact/feature_pairs.h"
#include "support/random.h"

namespace cloth::test {

/// Of some 0.4 m, near the origin; a mesh is a closed body or an irregular sheet of some dozens of triangles.
ObstacleBody random_body(Shape shape, Random& random);

/// At rest where the body is, at rest elsewhere, or shifted; maybe turned by up to 3 rad and grown as well.
PoseInterpolation random_interpolation(const ObstacleBody& body, Random& random);

/// rows x columns particles, and where they are: in a sheet of 0.4 m with folds and bumps about the origin.
struct Sheet {
  Surface surface;
  Vec3Field position;
};
Sheet random_sheet(int rows, int columns, Random& random);

/// The particles of a feature of the cloth, and the corners of one of a body's mesh or box.
std::vector<int> near_particles(const FeaturePair& pair, const Surface& cloth);
std::vector<Vec3> far_points(const FeaturePair& pair, const ObstacleBody& body);

/// All pairs of features that there are; of the cloth and itself those that share no particle.
std::vector<FeaturePair> all_pairs(const Surface& cloth, const std::vector<ObstacleBody>& bodies,
                                   bool with_itself);

}  // namespace cloth::test
