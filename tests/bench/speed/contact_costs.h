// What contact adds to a step: built-in scenes in which a cloth lies on something, with their contact and
// without any, from the same state.
#pragma once

#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"

namespace cloth::speed {

struct ContactCost {
  std::string scene;
  int rows = 0, columns = 0;           ///< particles
  std::size_t obstacle_triangles = 0;  ///< of meshes
  bool with_itself = false;
  int touched = 0;                 ///< particles, in the last step that was timed
  std::size_t pairs = 0;           ///< of features near each other, in that step
  Spread without = {}, with = {};  ///< ns per particle and step
  Spread ratio = {};               ///< with / without, sample by sample
  std::string remark = {};         ///< why there are no times
};

/// The scenes that are timed, in their order.
const std::vector<std::string>& contact_cost_scenes();

struct ContactPlan {
  TimingPlan timing;
  double part = 1;    ///< of the particles that the scene is timed with along an edge
  double settle = 0;  ///< s that it goes on after the first touch, before it is timed
};

/// The method is the scene's own at the step `auto`, on one thread. Precondition: the scene is one of
/// contact_cost_scenes(). The result has no times and no remark if `progress` ended it.
ContactCost measure_contact(const std::string& scene, const ContactPlan& plan,
                            const TimingProgress& progress = {});

}  // namespace cloth::speed
