#include "simulation/outcome.h"

#include <fmt/format.h>

namespace cloth {

const char* name_of(Status status) {
  switch (status) {
    case Status::finished:
      return "finished";
    case Status::stopped:
      return "stopped";
    case Status::diverged:
      return "diverged";
  }
  return "";
}

std::string describe(const Divergence& d) {
  std::string advice;
  if (d.stable_step <= 0)
    advice = "this method has no stable time step for this scene";
  else
    advice = fmt::format("the time step is {:.4g} s, stable for this scene is up to {:.4g} s", d.time_step,
                         d.stable_step);
  return fmt::format("diverged in step {} (t = {:.6g} s) at particle {} (row {}, column {}): {}; {}", d.step,
                     d.time, d.particle, d.row, d.column, d.cause, advice);
}

}  // namespace cloth
