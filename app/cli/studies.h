// What the commands that make a study share: the folder, the progress bar, the stop.
#pragma once

#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "console.h"
#include "parse.h"
#include "progress.h"
#include "study/study_recorder.h"

namespace clothlab::cli {

struct StudyPlace {
  std::string folder;      ///< empty: none
  std::string command;     ///< that makes the study
  std::string scene;       ///< that it reads; empty: none
  bool overwrite = false;  ///< an unfinished study of other inputs
  std::string shard = {};  ///< that is made alone; empty: the whole study
};

template <class Table>
struct MadeStudy {
  Table table;
  double wall = 0;  ///< s
};

/// Takes the folder for the study that `plan` is without its results, and says on standard error if an
/// unfinished one there goes on. The exit code, after a message, where that is refused.
std::optional<int> begin_study(cloth::StudyRecorder& recorder, const cloth::StudyTable& plan,
                               const StudyPlace& place, const std::optional<cloth::Shard>& shard);

/// Says how far a part is, with its exit code.
int end_shard(const cloth::StudyTable& table, const cloth::Shard& shard, const std::filesystem::path& place);

/// Runs a study, `run(options)`, and writes its folder: what is finished is on disk before the next run
/// begins. The exit code instead where only a part was to be made, and, after a message, where a file could
/// not be written.
template <class Table, class Options, class Run>
std::variant<MadeStudy<Table>, int> make_study(const Table& plan, Options options, const StudyPlace& place,
                                               Run run) {
  const auto chosen = chosen_shard(place.shard);
  if (const int* failed = std::get_if<int>(&chosen)) return *failed;
  const std::optional<cloth::Shard> shard = std::get<0>(chosen);
  if constexpr (requires { options.shard; })
    if (shard) options.shard = *shard;
  listen_for_stop();
  options.stop = stop_is_requested;
  cloth::StudyRecorder recorder;
  std::optional<cloth::IoError> failure;
  if (!place.folder.empty()) {
    if (const auto refused = begin_study(recorder, plan, place, shard)) return *refused;
    if (recorder.earlier()) options.earlier = &std::get<Table>(*recorder.earlier());
    options.partial = [&](const Table& so_far) {
      if (!failure) failure = recorder.keep(so_far);
    };
  }
  const auto start = std::chrono::steady_clock::now();
  MadeStudy<Table> made;
  {
    Progress bar;  // runs take very different times: what is left is a guess
    options.progress = [&](const cloth::StudyProgress& progress) {
      bar.show(progress.fraction, progress.text);
      return !failure && !stop_is_requested();
    };
    made.table = run(options);
  }
  made.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!failure && recorder.is_open()) failure = recorder.end(made.table, made.wall);
  if (failure) return report(*failure);
  if (shard) return end_shard(made.table, *shard, recorder.path());
  return made;
}

/// --set 'PATH=VALUE' for each, as in a command that makes the same.
std::string settings_text(const std::vector<std::string>& settings);

}  // namespace clothlab::cli
