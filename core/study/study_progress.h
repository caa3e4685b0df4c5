// What a study tells while it goes, and how it is stopped.
#pragma once

#include <functional>
#include <string>

namespace cloth {

struct StudyProgress {
  double fraction = 0;  ///< of the whole study, by estimated cost
  std::string text;     ///< what is being done
};

/// Asked between batches of steps, and from any thread; true stops the study. Empty: nothing does.
using StopTest = std::function<bool()>;

inline bool is_to_stop(const StopTest& stop) {
  return stop && stop();
}

}  // namespace cloth
