#include "studies.h"

#include <fmt/format.h>

#include "study/study_runs.h"

namespace clothlab::cli {

std::optional<int> begin_study(cloth::StudyRecorder& recorder, const cloth::StudyTable& plan,
                               const StudyPlace& place, const std::optional<cloth::Shard>& shard) {
  cloth::StudyStart start{.command = place.command, .overwrite = place.overwrite, .shard = shard};
  if (!place.scene.empty()) start.inputs = {place.scene};
  if (const auto error = recorder.begin(place.folder, plan, start)) {
    if (recorder.disagreements().empty()) return report(*error);
    for (const std::string& one : recorder.disagreements()) say(one);
    say(fmt::format("{}: nothing is made: see the results above", place.folder));
    return differs;
  }
  if (const cloth::StudyTable* earlier = recorder.earlier()) {
    const int parts = recorder.parts();
    const std::string what = parts == 0   ? "the unfinished study in the folder"
                             : parts == 1 ? "what 1 part of the study has"
                                          : fmt::format("what {} parts of the study have", parts);
    say(fmt::format("going on with {}: {} runs are there", what, cloth::finished_runs(*earlier)));
  }
  return std::nullopt;
}

int end_shard(const cloth::StudyTable& table, const cloth::Shard& shard, const std::filesystem::path& place) {
  const std::string made =
      fmt::format("{} runs of shard {}/{}", cloth::finished_runs(table), shard.index, shard.count);
  if (!stop_is_requested()) return print(fmt::format("{}; in {}\n", made, place.string()));
  say(fmt::format("stopped with {}; the same command goes on", made));
  return interrupted;
}

std::string settings_text(const std::vector<std::string>& settings) {
  std::string text;
  for (const std::string& setting : settings) text += " --set '" + setting + "'";
  return text;
}

}  // namespace clothlab::cli
