// Contact particle by particle at the end of every inner step of a method that divides its steps
// (InnerStepContact). The inner steps of Dormand and Prince's method are within the stability limit of the
// springs, and XPBD's are a tenth of a step, so that each particle is moved to the surface alone: the springs
// have not relaxed through the obstacle, as they do within a long step (contact/stiff_contact.h).
#pragma once

#include <utility>

#include "contact/obstacle_contact.h"
#include "integrators/integrator.h"

namespace cloth {

class InnerContact : public InnerStepContact {
 public:
  InnerContact(const ObstacleContact& contact, const ClothSystem& system, ContactMemory& memory)
      : contact_(contact), system_(system), memory_(memory) {}

  void begin(const ClothState& state) override;
  bool correct(double step, ClothState& state) override;

  /// Of all inner steps since the last call: their work, the contacts of the last one that had any.
  ContactReport take_report() { return std::exchange(report_, {}); }

 private:
  const ObstacleContact& contact_;
  const ClothSystem& system_;
  ContactMemory& memory_;
  Vec3Field position_, velocity_;  ///< m, m/s, at the beginning of the inner step
  ContactReport report_;
};

}  // namespace cloth
