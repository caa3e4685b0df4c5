// Contact as a stage of the step: after integrator and limiter it corrects positions and velocities, so that
// the cloth penetrates neither the obstacles nor itself. Two methods:
//  - particle by particle (obstacle_contact.h, after long steps with stiff_contact.h): the default, for
//    obstacles at rest whose shape is a solid;
//  - continuous (continuous_contact.h): where the scene has the block `contact` or `self_contact`, a moving
//    obstacle or one whose shape is a surface of triangles.
// Methods with MethodFacts::has_inner_steps meet contact of either kind at the end of every inner step, each
// a step here.
//
// Cost per step, particle by particle: every free particle is tested against every obstacle, so that two
// spheres cost two comparisons of squared distances per particle. If any particle is inside, all are tested a
// second time while the state is corrected, and methods that keep the force (MethodFacts::keeps_force)
// evaluate it once more. Before that correction, implicit methods with long steps find the positions of the
// particles inside by Newton's method: at most 12 linear solves over the whole cloth (stiff_contact.h), and
// with a deformation rate that it reaches at most 60 more (limited_contact.h).
//
// Cost per step, continuous: the cloth's bounds are computed, which is linear in particles; while an
// obstacle's bounds are away from them, it costs no more. Near the cloth, each round tests the bounds of
// every face of the cloth against each sphere, where the pairs of earlier rounds cannot be used again, and
// relaxes those pairs nearer than 1.5 thicknesses that the step brings to their thickness, in 20 sweeps, in
// up to 1000 for stacks of layers. A step is linear in faces and such pairs; it usually has fewer than ten
// rounds. After long steps of implicit methods up to 20 linear solves over the whole cloth come before,
// with a deformation rate up to 60 (stiff_target.h). With Verlet a touching step costs no more force
// evaluations than another, and one more where a limiter ties the closing kick to the drift.
// docs/performance.md has measured times.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "contact/contact_report.h"
#include "contact/obstacle_transition.h"
#include "geometry/bounds.h"
#include "integrators/integrator.h"
#include "kernels/thread_choice.h"

namespace cloth {

class WorkerTeam;

/// The step whose result contact corrects.
struct ContactStep {
  const ClothSystem& system;
  ForceModel& forces;
  Integrator& integrator;
  StepTimes times;
  const Vec3Field& position_before;  ///< m, at the beginning of the step
  const Vec3Field& velocity_before;  ///< m/s, at the beginning of the step
  ContactMemory& memory;             ///< in: of the last step; out: of this one
  std::function<double(const Vec3Field& position)> potential;  ///< J, elastic and gravity
  /// Brings the state, the integrator's result, within the deformation rate; returns whether that moved
  /// anything. Empty: there is none, or that has been done.
  std::function<bool()> limit = {};
};

class ContactStage {
 public:
  virtual ~ContactStage() = default;

  /// Corrects `state`, the result of integrator and limiter.
  virtual ContactReport resolve(const ContactStep& step, ClothState& state) = 0;

  /// Appends the contacts of the last step; `position` is its result, in m.
  virtual void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const = 0;

  virtual bool is_continuous() const { return false; }

  /// Whether it solves for the deformation rate with contact, or else calls ContactStep::limit.
  virtual bool solves_rate() const { return false; }

  // Only continuous contact has what follows.
  /// Null: one thread. Results do not depend on the team.
  virtual void set_team(WorkerTeam*, ThreadUse) {}
  /// Called several times within a step; when it returns true, the step ends with `interrupted`.
  virtual void set_stop_test(const std::function<bool()>&) {}
  /// The obstacles' poses at the beginning of the next step; empty: those of the scene.
  virtual const std::vector<Pose>& poses() const {
    static const std::vector<Pose> none;
    return none;
  }
  /// Sets the poses (one for each obstacle) and the transitions for the next step; the contacts of the last
  /// step are dropped.
  virtual void restore(const std::vector<Pose>&, const ObstacleTransitions&, const ThicknessTransition&) {}
  /// See PairSearch.
  virtual int hierarchy_depth(int /*body*/) const { return 0; }
  virtual void append_boxes(int /*body*/, int /*level*/, const Vec3Field& /*position*/,
                            std::vector<Bounds>& /*boxes*/) {}
};

/// Null if the scene has neither obstacles nor self-contact. The obstacles' poses are those of scene and
/// transitions at `time` (s). `long_steps`: the time step exceeds the stability limit of explicit methods, so
/// that contact and springs have to be solved together.
std::unique_ptr<ContactStage> make_contact_stage(const Scene& scene, const ClothSystem& system,
                                                 const ObstacleTransitions& transitions,
                                                 const ThicknessTransition& thickness, double time,
                                                 bool long_steps);

}  // namespace cloth
