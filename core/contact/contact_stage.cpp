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
    if (!contact_.touches(step.system, state)) return {};
    ContactBegin begin{step.position_before, step.velocity_before, step.times.step, step.memory};
    ConstrainedStep constrained;
    if (long_steps_ && !contact_.is_inside(step.system, step.position_before)) {
      constrained.weight = step.stage_weight * step.times.step;
      constrained.position = state.position;
      constrained.held =
          stiff_contact_.solve(step.system, step.forces, contact_.obstacles(), constrained.weight,
                               step.times.end, step.position_before, constrained.position);
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

class PathContact : public ContactStage {
 public:
  PathContact(const Scene& scene, const ClothSystem& system, const ObstacleTransitions& transitions,
              const ThicknessTransition& thickness, double time)
      : contact_(scene, system, transitions, thickness, time) {}

  ContactReport resolve(const ContactStep& step, ClothState& state) override {
    const ContactTimes times{step.times.begin, step.times.end, step.times.step};
    if (!contact_.is_near(step.position_before, times, state)) return {};
    VelocityCoupling coupling{step.velocity_before, step.memory, step.potential, {}, {}};
    const bool follows = step.integrator.velocity_follows_positions();
    if (follows)
      coupling.positions = [&](const Vec3Field& motion) {
        step.integrator.follow_positions(step.system, step.forces, step.times, motion, state);
      };
    if (follows && step.forces.has_damping())
      coupling.velocities = [&](const Vec3Field& motion) {
        step.integrator.follow_velocities(step.system, step.forces, step.times, motion, state);
      };
    return contact_.apply(step.system, step.position_before, times, state, coupling);
  }

  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const override {
    contact_.append_marks(position, marks);
  }
  bool is_continuous() const override { return true; }
  void set_team(WorkerTeam* team) override { contact_.set_team(team); }
  void set_stop_test(const std::function<bool()>& test) override { contact_.set_stop_test(test); }
  const std::vector<Pose>& poses() const override { return contact_.poses(); }
  void restore(const std::vector<Pose>& poses, const ObstacleTransitions& transitions,
               const ThicknessTransition& thickness) override {
    contact_.set_transitions(transitions, thickness);
    contact_.set_poses(poses);
    contact_.forget_touches();
  }
  int hierarchy_depth(int body) const override { return contact_.hierarchy_depth(body); }
  void append_boxes(int body, int level, const Vec3Field& position, std::vector<Bounds>& boxes) override {
    contact_.append_boxes(body, level, position, boxes);
  }

 private:
  ContinuousContact contact_;
};

}  // namespace

std::unique_ptr<ContactStage> make_contact_stage(const Scene& scene, const ClothSystem& system,
                                                 const ObstacleTransitions& transitions,
                                                 const ThicknessTransition& thickness, double time,
                                                 bool long_steps) {
  if (has_continuous_contact(scene))
    return std::make_unique<PathContact>(scene, system, transitions, thickness, time);
  if (scene.obstacles.empty()) return nullptr;
  return std::make_unique<ParticleContact>(scene, long_steps);
}

}  // namespace cloth
