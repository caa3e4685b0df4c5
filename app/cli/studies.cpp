#include "studies.h"

#include <fmt/format.h>

#include "console.h"
#include "study/study_runs.h"

namespace clothlab::cli {

void say_what_goes_on(const cloth::StudyRecorder& recorder) {
  if (const cloth::StudyTable* earlier = recorder.earlier())
    say(fmt::format("going on with the unfinished study in the folder: {} runs are there",
                    cloth::finished_runs(*earlier)));
}

}  // namespace clothlab::cli
