// What every command shares: exit codes, where a scene comes from, how a message looks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/text_file.h"
#include "params/problem.h"
#include "scene/scene.h"
#include "scene/scene_json.h"
#include "simulation/run_summary.h"

namespace clothlab::cli {

/// `defect`: an error of the program itself, which no input should bring about.
enum ExitCode {
  done = 0,
  defect = 1,
  bad_input = 2,
  diverged = 3,
  rate_not_kept = 3,
  io_failed = 4,
  differs = 5,
  not_identified = 6,
  interrupted = 130
};

/// Names the program in its messages; defined beside its main().
extern const char* const program_name;

/// A scene, or the exit code of a command whose messages are already on standard error.
struct LoadedScene {
  std::optional<cloth::Scene> scene;
  int exit_code = done;
};

/// `name` is a file or the name of a built-in scene; a file wins. `settings` are PATH=VALUE.
LoadedScene load_scene(const std::string& name, const std::vector<std::string>& settings);

/// What a name stands for: the text of a file, or of what is built in; or the exit code of a command whose
/// message is already on standard error.
struct NamedText {
  std::string text;
  bool is_file = false;
  int exit_code = done;
};

/// A file wins, but not a folder: one of results may well have the name of the scene that it came from.
/// `built_in` is null where nothing is; `what` says what there might be, and `lister` which command lists it.
NamedText read_named(const std::string& name, const std::string* built_in, const char* what,
                     const char* lister);

/// `settings` are PATH=VALUE; nothing, and a message, if one is not.
std::optional<std::vector<cloth::Override>> parse_settings(const std::vector<std::string>& settings);

int report(const std::vector<cloth::Problem>& problems);
/// What would destroy something is bad usage, all else a failure to read or write.
int report(const cloth::IoError& error);

/// Standard output is written whole or the command fails: exit code 4 on a full disk or a closed pipe.
/// Control characters within lines are escaped, in a way that leaves JSON its meaning.
int print(const std::string& text);

/// A run in a few lines; `folder` is where its files are, or empty.
std::string summary_text(const cloth::RunSummary& summary, const std::string& folder);

/// What is not as asked for, and why a run ended early, on standard error.
void say_what_went_wrong(const cloth::RunSummary& summary);
int exit_code_of(const cloth::RunSummary& summary);

/// Writes to standard error with the program's name before it, made printable. Never fails: where standard
/// error is closed or full, the exit code is left to tell.
void say(const std::string& message);

/// To standard error as it is.
void write_error(const std::string& text);

/// io_failed, and a message with the size, where a run of the scene needs more memory than there is with one
/// of the methods (of the scene's own without any); `done` otherwise.
int refused_for_memory(cloth::Scene scene, const std::vector<std::string>& methods = {});

/// Runs a program's command with the standard streams open and every way to end it an exit code: the
/// command's own, or that of the exception which it ended by, with a message.
int run_program(const std::function<int()>& command);

}  // namespace clothlab::cli
