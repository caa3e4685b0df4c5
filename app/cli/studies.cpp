#include "studies.h"

#include <fmt/format.h>

#include "study/study_runs.h"

namespace clothlab::cli {

std::optional<cloth::IoError> begin_study(cloth::StudyRecorder& recorder, const cloth::StudyTable& plan,
                                          const StudyPlace& place) {
  cloth::StudyStart start{.command = place.command, .overwrite = place.overwrite};
  if (!place.scene.empty()) start.inputs = {place.scene};
  if (auto error = recorder.begin(place.folder, plan, start)) return error;
  if (const cloth::StudyTable* earlier = recorder.earlier())
    say(fmt::format("going on with the unfinished study in the folder: {} runs are there",
                    cloth::finished_runs(*earlier)));
  return std::nullopt;
}

std::string settings_text(const std::vector<std::string>& settings) {
  std::string text;
  for (const std::string& setting : settings) text += " --set '" + setting + "'";
  return text;
}

}  // namespace clothlab::cli
