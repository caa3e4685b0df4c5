// How a step or a run ended. Bad numerics are data.
#pragma once

#include <cstdint>
#include <string>

namespace cloth {

enum class Status { finished, stopped, diverged };
const char* name_of(Status status);

/// Why and where a run diverged.
struct Divergence {
  std::int64_t step = 0;  ///< the first one that was not accepted
  double time = 0;        ///< s, at its end
  int particle = 0;
  int row = 0, column = 0;
  std::string cause;     ///< "position is not finite", ...
  double time_step = 0;  ///< s, as run
  double stable_step =
      0;  ///< s, the method's limit for the scene; 0 if there is none, infinity if any will do
  bool solver_failed = false;  ///< the equations of the step could not be solved: nothing has run away
};

/// One sentence: what, where, when, and what would help.
std::string describe(const Divergence& divergence);

}  // namespace cloth
