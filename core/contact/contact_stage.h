// Contact as a stage of the step: after integrator and limiter it brings the cloth to where obstacles, and
// the cloth itself, let it be. Two kinds: particle by particle (obstacle_contact.h, with stiff_contact.h
// after long steps), and continuous (continuous_contact.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "contact/contact_mark.h"
#include "contact/contact_memory.h"
#include "contact/contact_report.h"
#include "contact/obstacle_transition.h"
#include "geometry/bounds.h"
#include "integrators/integrator.h"

namespace cloth {

class WorkerTeam;

/// The step that contact follows.
struct ContactStep {
  const ClothSystem& system;
  ForceModel& forces;
  Integrator& integrator;
  StepTimes times;
  double stage_weight = 1;           ///< of the step, with which the method counts forces; see MethodFacts
  const Vec3Field& position_before;  ///< m, at the step's begin
  const Vec3Field& velocity_before;  ///< m/s
  ContactMemory& memory;             ///< of the last step, and then of this one
  std::function<double(const Vec3Field& position)> potential;  ///< J, elastic and gravity
};

class ContactStage {
 public:
  virtual ~ContactStage() = default;

  /// `state` is where integrator and limiter have put the cloth, and becomes where contact lets it be. The
  /// report says `acted` unless nothing was touched, or `interrupted`.
  virtual ContactReport resolve(const ContactStep& step, ClothState& state) = 0;

  /// Appends where the cloth touched something at the end of the last step.
  virtual void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const = 0;

  virtual bool is_continuous() const { return false; }

  // Of continuous contact; the other kind has none of it.
  /// Threads to share work among, null: one; the same bits for any team.
  virtual void set_team(WorkerTeam*) {}
  /// Asked within a step; where it says so the report is `interrupted`.
  virtual void set_stop_test(const std::function<bool()>&) {}
  /// Where the obstacles are as the next step begins, one of each; none: where the scene says.
  virtual const std::vector<Pose>& poses() const {
    static const std::vector<Pose> none;
    return none;
  }
  /// Goes on from there, with the transitions that edits have begun; the touches of the last step are
  /// forgotten.
  virtual void restore(const std::vector<Pose>&, const ObstacleTransitions&, const ThicknessTransition&) {}
  /// See PairSearch.
  virtual int hierarchy_depth(int /*body*/) const { return 0; }
  virtual void append_boxes(int /*body*/, int /*level*/, const Vec3Field& /*position*/,
                            std::vector<Bounds>& /*boxes*/) {}
};

/// The contact that `scene` asks for, null: none. Obstacles are where scene and transitions say they are at
/// `time`, in s. `long_steps`: beyond what an explicit method stands, so that springs have to give way
/// within a step.
std::unique_ptr<ContactStage> make_contact_stage(const Scene& scene, const ClothSystem& system,
                                                 const ObstacleTransitions& transitions,
                                                 const ThicknessTransition& thickness, double time,
                                                 bool long_steps);

}  // namespace cloth
