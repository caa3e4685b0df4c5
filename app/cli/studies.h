// What the commands that make a study share: the folder, the progress bar, the stop.
#pragma once

#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "console.h"
#include "progress.h"
#include "study/study_recorder.h"

namespace clothlab::cli {

struct StudyPlace {
  std::string folder;      ///< empty: none
  std::string command;     ///< that makes the study
  std::string scene;       ///< that it reads; empty: none
  bool overwrite = false;  ///< an unfinished study of other inputs
};

template <class Table>
struct MadeStudy {
  Table table;
  double wall = 0;  ///< s
};

/// Takes the folder for the study that `plan` is without its results, and says on standard error if an
/// unfinished one there goes on.
std::optional<cloth::IoError> begin_study(cloth::StudyRecorder& recorder, const cloth::StudyTable& plan,
                                          const StudyPlace& place);

/// Runs a study, `run(options)`, and writes its folder: what is finished is on disk before the next run
/// begins. The exit code instead, after a message, where a file could not be written.
template <class Table, class Options, class Run>
std::variant<MadeStudy<Table>, int> make_study(const Table& plan, Options options, const StudyPlace& place,
                                               Run run) {
  listen_for_stop();
  options.stop = stop_is_requested;
  cloth::StudyRecorder recorder;
  std::optional<cloth::IoError> failure;
  if (!place.folder.empty()) {
    if (const auto error = begin_study(recorder, plan, place)) return report(*error);
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
  return made;
}

/// --set 'PATH=VALUE' for each, as in a command that makes the same.
std::string settings_text(const std::vector<std::string>& settings);

}  // namespace clothlab::cli
