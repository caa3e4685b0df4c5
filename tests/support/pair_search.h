// Searches for pairs in random motions, against a look at all pairs of features.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <vector>

#include "contact/near_pairs.h"
#include "support/contact_bodies.h"

namespace cloth::test {

/// Every particle goes its way evenly within the step and keeps this far from the border of its capsule.
struct Motion {
  Vec3Field from, to;
  double margin = 0;                // m
  double reach = 0, own_reach = 0;  // m

  SweptBounds swept() const {
    SweptBounds swept{.reach = reach, .own_reach = own_reach};
    swept.from = from, swept.to = to;
    swept.radius.assign(from.size(), margin);
    return swept;
  }
  Vec3 at(int i, double part) const {
    const auto n = static_cast<std::size_t>(i);
    return (1 - part) * from[n] + part * to[n];
  }
};

Motion random_motion(const Vec3Field& from, double furthest, Random& random);

std::vector<int> far_particles(const FeaturePair& pair, const Surface& cloth);

/// The least distance that the features of a pair are seen to have within the step, in m.
double least_distance(const FeaturePair& pair, const Surface& cloth, const Motion& motion,
                      const std::vector<ObstacleBody>& bodies, const std::vector<PoseInterpolation>& paths);

/// Without the direction of pairs of own edges.
std::set<FeaturePair> told_apart(const std::vector<FeaturePair>& pairs);

/// A sheet and obstacles on their paths.
struct Intersection {
  std::vector<ObstacleBody> bodies;
  std::vector<PoseInterpolation> paths;
  Sheet sheet;
};

Intersection random_meeting(Random& random);

/// How many pairs came near and how many did not, of those looked at.
struct Looked {
  std::size_t near = 0, far = 0;
};

void expect_none_missed(const std::vector<FeaturePair>& pairs, const Intersection& meeting,
                        const Motion& motion, Looked& looked, bool with_itself = true);

/// Forty steps, mostly small ones, in which reach and obstacles change now and then.
template <class Look>
void walk(Random& random, const Look& look) {
  Intersection meeting = random_meeting(random);
  Motion motion{meeting.sheet.position, meeting.sheet.position, 0.003, 0.005, 0.005};
  look(meeting, motion, true);
  for (int step = 0; step < 40; ++step) {
    const double reach = motion.reach;
    motion = random_motion(motion.to, random.integer(0, 9) == 0 ? 0.05 : 0.002, random);
    const int change = random.integer(0, 30);
    motion.reach = motion.own_reach = change == 0 ? random.uniform(0.001, 0.01) : reach;
    motion.margin = 0.0005;
    if (change < 3 && !meeting.bodies.empty())
      meeting.paths[0] = random_interpolation(meeting.bodies[0], random);
    look(meeting, motion, false);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace cloth::test
