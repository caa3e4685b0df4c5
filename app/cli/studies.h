// What the commands that make a study share.
#pragma once

#include "study/study_recorder.h"

namespace clothlab::cli {

/// Says on standard error that an unfinished study in the folder goes on, and how much of it there is.
void say_what_goes_on(const cloth::StudyRecorder& recorder);

}  // namespace clothlab::cli
