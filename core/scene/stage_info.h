// One stage of a step, as `explain` tells it.
#pragma once

#include <string>

namespace cloth {

struct StageInfo {
  std::string name;
  bool present = false;
  std::string reason;  ///< what it does here, or why it is not needed
};

}  // namespace cloth
