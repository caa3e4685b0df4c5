// What a run has come to, taken and given back.
#include "contact/contact_stage.h"
#include "integrators/integrator.h"
#include "simulation/simulation.h"

namespace cloth {

std::size_t Checkpoint::bytes() const {
  std::size_t numbers = tension.size() + force_history.size() + memory.numbers.size() +
                        state.position.flat().size() + state.velocity.flat().size();
  for (const Vec3Field& field : memory.fields) numbers += field.flat().size();
  numbers += contact_memory.deferred.size();
  return sizeof(Checkpoint) + sizeof(StepChange) * automatic.changes.size() + sizeof(double) * numbers +
         contact_memory.held.size() + sizeof(Pose) * obstacle_poses.size() +
         sizeof(ObstacleTransition) * transitions.size();
}

Checkpoint Simulation::checkpoint() const {
  Checkpoint checkpoint;
  static_cast<RunState&>(checkpoint) = run_;
  checkpoint.method = scene_.integrator.method;
  checkpoint.memory = integrator_->remember();
  if (contact_) checkpoint.obstacle_poses = contact_->poses();
  if (limiter_) checkpoint.tension = limiter_->tension();
  checkpoint.force_history = forces_->history();
  return checkpoint;
}

/// The step that the scene says stays in force where the checkpoint had another.
void Simulation::restore(const Checkpoint& checkpoint) {
  const double time_step = run_.time_step;
  AutomaticStep automatic = std::move(run_.automatic);
  run_ = checkpoint;
  was_finite_ = false;
  if (run_.automatic.longest != automatic.longest)
    run_.first_time = run_.state.time, run_.first_step = run_.state.step;
  if (run_.automatic.longest != automatic.longest || !watches_step_)
    run_.time_step = time_step, run_.automatic = std::move(automatic);
  quantities_.brush = run_.was_brushed, quantities_.pull = run_.was_pulled;
  make_limiter(checkpoint.tension);
  forces_->set_history(checkpoint.force_history, run_.state.position);
  apply_hand();
  if (run_.transitions.size() != scene_.obstacles.size()) run_.transitions.clear();
  const bool same_method = checkpoint.method == scene_.integrator.method;
  if (!same_method) end_contact();
  restore_obstacles(checkpoint.obstacle_poses);
  if (same_method)
    integrator_->recall(checkpoint.memory);
  else
    integrator_->forget(Change::state);
}

/// Where the checkpoint's scene had others, they are where the present scene says.
void Simulation::restore_obstacles(const std::vector<Pose>& poses) {
  if (!has_continuous_contact()) return;
  std::vector<Pose> of_scene;
  for (std::size_t k = 0; k < scene_.obstacles.size(); ++k)
    of_scene.push_back(pose_in_transition(scene_.obstacles, run_.transitions, k, run_.state.time));
  contact_->restore(poses.size() == of_scene.size() ? poses : of_scene, run_.transitions,
                    run_.thickness_transition);
}

}  // namespace cloth
