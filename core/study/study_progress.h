// How far a study has come.
#pragma once

#include <string>

namespace cloth {

struct StudyProgress {
  double fraction = 0;  ///< of the whole study, by estimated cost
  std::string text;     ///< what is being done
};

}  // namespace cloth
