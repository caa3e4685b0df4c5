// What is timed: one hanging cloth, and the same with one thing more, in a state in which its springs pull.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace cloth::speed {

/// One thing that a scene may have; the first of the list is "bare" and adds nothing.
struct Feature {
  std::string name;   ///< for options and files: "limit-10"
  std::string title;  ///< for people: "limit to 10 %"
  void (*add)(Scene&);
};
const std::vector<Feature>& features();
const Feature& bare_feature();
/// Precondition: one of that name exists.
const Feature& feature_named(const std::string& name);

/// `size` x `size` particles pinned at two corners, springs in six directions, gravity, and the feature. The
/// time step is `auto`; where the method has no stable one, it is the one that viscous damping would allow.
Scene hanging_cloth(int size, const std::string& method, const Feature& feature);

/// The cloth after this many s of hanging: not the flat sheet, in which no spring pulls yet.
inline constexpr double hanging_time = 0.4;

/// That state of a cloth of 32 x 32 particles with this feature (Verlet), carried over to `size` x `size` by
/// bilinear interpolation in the sheet, so that every size starts with the same shape and the same strains.
class DevelopedCloth {
 public:
  explicit DevelopedCloth(const Feature& feature);

  /// Puts `simulation` of a square cloth into the state, at time 0.
  void put_into(Simulation& simulation) const;

 private:
  static constexpr int size_ = 32;
  ClothState state_;
};

/// One developed cloth of each feature, made when it is first asked for.
class DevelopedCloths {
 public:
  const DevelopedCloth& of(const std::string& feature);

 private:
  std::map<std::string, DevelopedCloth> made_;
};

}  // namespace cloth::speed
