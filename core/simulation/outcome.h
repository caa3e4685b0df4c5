// How a step or a run ended. Bad numerics are data.
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
  double largest_residual = 0;  ///< of a step's last iteration, see IntegratorReport

  /// What was added since `earlier`; the largest residual remains that of the whole run.
  StepCount since(const StepCount& earlier) const;
};

/// Why and where a run diverged.
struct Divergence {
  std::int64_t step = 0;  ///< the first one that was not accepted
  double time = 0;        ///< s, at its end
  int particle = 0;
  bool on_grid = true;  ///< a mesh has no rows and columns
  int row = 0, column = 0;
  std::string cause;     ///< "position is not finite", ...
  double time_step = 0;  ///< s, as run
  double stable_step =
      0;  ///< s, the method's limit in every shape; 0 if there is none, infinity if any will do
  bool solver_failed = false;  ///< the equations of the step could not be solved: no divergence
  bool pinched = false;        ///< an obstacle met cloth that cannot give way: no divergence
};

/// A shorter step that came in force by itself.
struct StepChange {
  std::int64_t step = 0;  ///< after which
  double time = 0;        ///< s, then
  double time_step = 0;   ///< s
  bool operator==(const StepChange&) const = default;
};

/// One sentence: what, where, when, and what would help.
std::string describe(const Divergence& divergence);

/// One sentence: how often and where the step became shorter. Empty: never.
std::string describe(const std::vector<StepChange>& changes);

/// Where springs were left beyond the deformation rate and its tolerance. The run goes on, but it is not the
/// run that the scene asks for.
struct RateBreach {
  std::int64_t steps = 0;                       ///< in which that was so
  std::int64_t first_step = 0;                  ///< the first of them
  double first_time = 0;                        ///< s, at its end
  int first_particle = 0, second_particle = 0;  ///< ends of the spring that was furthest beyond then
  double first_excess = 0;                      ///< (|d| - (1 + rate) L)/L of that spring
  std::int64_t largest_step = 0;                ///< where it was worst
  double largest_excess = 0;
  bool unreachable = false;  ///< in the first of them the pins were too far apart
  bool by_contact = false;   ///< in the first of them contact stretched what the limiter had limited
  int columns = 0;           ///< of the grid; 0 for a mesh
  bool operator==(const RateBreach&) const = default;
};

/// One sentence, "rate not kept: ...".
std::string describe(const RateBreach& breach);

}  // namespace cloth
