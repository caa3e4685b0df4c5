#include "contact/contact_stage.h"

#include "contact/continuous_contact.h"
#include "contact/limited_contact.h"
#include "contact/obstacle_contact.h"
#include "contact/stiff_contact.h"

namespace cloth {
namespace {

class ParticleContact : public ContactStage {
 public:
  ParticleContact(const Scene& scene, const ClothSystem& system, bool long_steps)
      : contact_(scene.obstacles, gravity_of(scene).norm()), long_steps_(long_steps) {
    if (long_steps && scene.deformation) rate_.emplace(*scene.deformation, system);
  }

  ContactReport resolve(const ContactStep& step, ClothState& state) override {
    ContactBegin begin{step.position_before, step.velocity_before, step.times.step, step.memory};
    if (!long_steps_) return contact_.apply(step.system, begin, state);
    const bool is_solved = !contact_.is_inside(step.system, step.position_before);
    if (step.limit && !(is_solved && contact_.touches(step.system, state))) step.limit();
    if (!contact_.touches(step.system, state)) return {};
    ConstrainedStep constrained;
    Solution solution;
    if (is_solved) solution = solve(step, state, constrained), begin.constrained = &constrained;
    ContactReport report = contact_.apply(step.system, begin, state);
    report.acted = true;
    report.rate_work = solution.rate_work, report.force_work = solution.force_work;
    return report;
  }

  bool solves_rate() const override { return rate_.has_value(); }

  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const override {
    contact_.append_marks(position, marks);
  }

 private:
  /// Of a step solved with contact, at the velocities of its solution.
  struct Solution {
    double rate_work = 0;            ///< J
    std::optional<Work> force_work;  ///< see ContactReport
  };
  /// The step with contact, and with the rate where the positions without it would exceed that.
  Solution solve(const ContactStep& step, const ClothState& state, ConstrainedStep& solved) {
    solved.weight = step.integrator.last_stage_weight() * step.times.step;
    solved.position = state.position;
    LongStep whole{solved.weight, step.times.end, step.position_before, state.velocity,
                   step.integrator.force_left(step.forces, step.times)};
    const std::vector<Obstacle>& obstacles = contact_.obstacles();
    const bool begins_within = !step.limit || rate_->keeps(state.position);
    if (begins_within)
      solved.held = stiff_contact_.solve(step.system, step.forces, obstacles, whole, solved.position);
    if (step.limit && !(begins_within && rate_->keeps(solved.position))) {
      whole.rate = &*rate_;
      solved.position = state.position;
      solved.held = limited_contact_.solve(step.system, step.forces, obstacles, whole, solved.position);
    }
    ClothState there{solved.position, state.velocity};
    add_scaled(1 / solved.weight, solved.position, there.velocity);
    add_scaled(-1 / solved.weight, state.position, there.velocity);
    Solution solution;
    if (whole.rate) solution.rate_work = solved.weight * rate_->power(there.position, there.velocity);
    solution.force_work = step.integrator.correct_work(step.forces, step.times, there);
    return solution;
  }

  ObstacleContact contact_;
  StiffContact stiff_contact_;
  LimitedContact limited_contact_;
  std::optional<RateTensions> rate_;  ///< of long steps, if the scene has a rate
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
  return std::make_unique<ParticleContact>(scene, system, long_steps);
}

}  // namespace cloth
