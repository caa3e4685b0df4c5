// How a step or a run ended. Divergence is a reported result, not an error.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cloth {

enum class Status { finished, stopped, diverged };
const char* name_of(Status status);

/// What the steps so far have cost.
struct StepCount {
  std::int64_t steps = 0, force_evaluations = 0, velocity_iterations = 0, limiter_sweeps = 0;
  std::int64_t inner_steps = 0, rejected_steps = 0;
  std::int64_t iterations = 0, linear_iterations = 0, factorisations = 0;  ///< of implicit methods
  std::int64_t held_normals = 0;  ///< steps in which air acted along the normals of their beginning
  double largest_residual = 0;    ///< of a step's last iteration, see IntegratorReport

  /// What was added since `earlier`; the largest residual remains that of the whole run.
  StepCount since(const StepCount& earlier) const;
};

/// One sentence: in how many steps an implicit method did not solve its equations as they are. Empty: in
/// none.
std::string describe(const StepCount& count);

/// Why and where a run diverged.
struct Divergence {
  std::int64_t step = 0;  ///< the first one that was not accepted
  double time = 0;        ///< s, at its end
  int particle = 0;
  bool on_grid = true;  ///< a mesh has no rows and columns
  int row = 0, column = 0;
  std::string cause;     ///< "position is not finite", ...
  double time_step = 0;  ///< s, used in the run
  /// s, the largest step that is stable for every shape of the cloth; 0: none is, infinity: all are.
  double stable_step = 0;
  bool solver_failed = false;  ///< the equations of the step could not be solved: no divergence
  bool pinched = false;        ///< an obstacle pressed on cloth that cannot move away: no divergence
};

/// An automatic reduction of the time step.
struct StepChange {
  std::int64_t step = 0;  ///< the last one before the change
  double time = 0;        ///< s, of the change
  double time_step = 0;   ///< s
  bool operator==(const StepChange&) const = default;
};

/// One sentence: what, where, when, and what would help.
std::string describe(const Divergence& divergence);

/// One sentence: how often and where the step became shorter. Empty: never.
std::string describe(const std::vector<StepChange>& changes);

/// Where springs were left beyond the deformation rate and its tolerance. The run goes on, but its result
/// violates the scene's deformation rate.
struct RateBreach {
  std::int64_t steps = 0;                       ///< in which the rate was exceeded
  std::int64_t first_step = 0;                  ///< the first of those
  double first_time = 0;                        ///< s, at its end
  int first_particle = 0, second_particle = 0;  ///< ends of the spring with the largest excess in that step
  double first_excess = 0;                      ///< (|d| - (1 + rate) L)/L of that spring
  std::int64_t largest_step = 0;                ///< the step with the largest excess
  double largest_excess = 0;
  bool unreachable = false;  ///< in `first_step` the pins were too far apart
  bool by_contact = false;   ///< in `first_step` contact stretched springs after the limiter
  int columns = 0;           ///< of the grid; 0 for a mesh
  bool operator==(const RateBreach&) const = default;
};

/// One sentence, "rate not kept: ...".
std::string describe(const RateBreach& breach);

}  // namespace cloth
