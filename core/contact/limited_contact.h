// Contact particle by particle together with a deformation rate, after steps that are long compared with the
// springs' oscillations. Each particle that is or was inside an obstacle is kept outside of a plane, the
// surface's tangent beside it, and the planes and the rate are constraints of the step's own equation
// (contact/stiff_target.h). Without a rate contact/stiff_contact.h solves the same equation in fewer
// iterations: it holds particles on the surfaces themselves, between which springs at their longest leave no
// way.
#pragma once

#include <span>
#include <vector>

#include "contact/obstacle_contact.h"
#include "contact/stiff_target.h"

namespace cloth {

class LimitedContact {
 public:
  /// Moves `position`, the result of the step, out of the obstacles and within the rate, step.rate. Returns
  /// the particles in contact, in their order.
  std::vector<HeldParticle> solve(const ClothSystem& system, ForceModel& forces,
                                  std::span<const Obstacle> obstacles, const LongStep& step,
                                  Vec3Field& position);

 private:
  void renew(const ClothSystem& system, const Vec3Field& begin, const Vec3Field& position);
  std::vector<HeldParticle> hold(double weight, Vec3Field& position) const;

  /// Of a particle and an obstacle.
  struct Side {
    std::size_t particle = 0, obstacle = 0;
  };
  std::span<const Obstacle> obstacles_;
  std::vector<std::uint8_t> is_met_;       ///< of each particle, one after the other for each obstacle
  std::vector<Side> sides_;                ///< those met, as they were met
  std::vector<ContactConstraint> planes_;  ///< of those
  StiffTarget target_;
};

}  // namespace cloth
