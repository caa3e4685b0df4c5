#include "contact/contact_stage.h"

#include "contact/continuous_contact.h"
#include "contact/obstacle_contact.h"
#include "contact/stiff_contact.h"

namespace cloth {
namespace {

class ParticleContact : public ContactStage {
 public:
  ParticleContact(const Scene& scene, bool long_steps)
      : contact_(scene.obstacles, gravity_of(scene).norm()), long_steps_(long_steps) {}

  ContactReport resolve(const ContactStep& step, ClothState& state) override {
    ContactBegin begin{step.position_before, step.velocity_before, step.times.step, step.memory};
    if (!long_steps_) return contact_.apply(step.system, begin, state);
    if (!contact_.touches(step.system, state)) return {};
    ConstrainedStep constrained;
    if (!contact_.is_inside(step.system, step.position_before)) {
      constrained.weight = step.stage_weight * step.times.step;
      constrained.position = state.position;
      const LongStep long_step{constrained.weight, step.times.end, step.position_before, state.velocity,
                               step.integrator.force_left(step.forces, step.times)};
      constrained.held = stiff_contact_.solve(step.system, step.forces, contact_.obstacles(), long_step,
                                              constrained.position);
      begin.constrained = &constrained;
    }
    ContactReport report = contact_.apply(step.system, begin, state);
    report.acted = true;
    return report;
  }

  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const override {
    contact_.append_marks(position, marks);
  }

 private:
  ObstacleContact contact_;
  StiffContact stiff_contact_;
  bool long_steps_;
};

}  // namespace

std::unique_ptr<ContactStage> make_contact_stage(const Scene& scene, const ClothSystem& system,
                                                 const ObstacleTransitions& transitions,
                                                 const ThicknessTransition& thickness, double time,
                                                 bool long_steps) {
  if (has_continuous_contact(scene))
    return std::make_unique<ContinuousContact>(scene, system, transitions, thickness, time, long_steps);
  if (scene.obstacles.empty()) return nullptr;
  return std::make_unique<ParticleContact>(scene, long_steps);
}

}  // namespace cloth
