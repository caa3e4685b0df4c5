// Contact at the end of every inner step of a method that divides its steps (InnerStepContact), and what it
// has done since it was last asked.
#pragma once

#include <functional>
#include <optional>

#include "contact/contact_report.h"
#include "integrators/integrator.h"

namespace cloth {

class InnerContact : public InnerStepContact {
 public:
  /// Corrects the result of an inner step that began at the positions and velocities; nothing where the
  /// state has diverged, which ends the step.
  using Resolve = std::function<std::optional<ContactReport>(
      const StepTimes& times, const Vec3Field& position_before, const Vec3Field& velocity_before)>;
  explicit InnerContact(Resolve resolve) : resolve_(std::move(resolve)) {}

  void begin(const ClothState& state) override;
  Outcome correct(const StepTimes& times, ClothState& state) override;

  /// Of all inner steps since the last call: sums of work, impulse and rounds, the most particles that were
  /// held back in one, the contacts of the last one that had any, and what ended it.
  ContactReport take_report();

 private:
  Resolve resolve_;
  Vec3Field position_, velocity_;  ///< m, m/s, at the beginning of the inner step
  ContactReport report_;
};

}  // namespace cloth
