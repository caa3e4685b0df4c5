// One run of a study, by the number that its diagrams give it.
#pragma once

#include <optional>
#include <string>

#include "study/study_folder.h"

namespace cloth {

struct StudyRun {
  std::string name;    ///< "Verlet, step 0.0012 s"
  std::string status;  ///< as the CSV says it
  Scene scene;         ///< method, step and values as they were run; the title says whose run it is
  std::string note;    ///< what a scene cannot say of the run; empty: it says all
};

/// Runs are counted method after method (extremes: case after case), as in the CSV. nullopt: no such run, or
/// it was never run.
std::optional<StudyRun> run_of(const StudyTable& table, int number);

/// How many runs there are in the table, finished or failed.
int finished_runs(const StudyTable& table);

}  // namespace cloth
