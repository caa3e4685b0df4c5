// How a program of the command line gets its arguments, and the options that several commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/shard.h"

namespace clothlab::cli {

/// A program of several commands.
struct Program {
  CLI::App app;
  std::function<int()> chosen{};  ///< runs the command that was asked for; returns the exit code
};

template <class Arguments>
struct Command {
  CLI::App& options;
  Arguments& arguments;
};

/// Adds a command that `run` carries out with the arguments, which its options fill in.
template <class Arguments>
Command<Arguments> add_command(Program& program, const char* name, const char* help,
                               int (*run)(const Arguments&)) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.app.add_subcommand(name, help);
  command->callback([&program, arguments, run] { program.chosen = [=] { return run(*arguments); }; });
  return {*command, *arguments};
}

/// Adds --version and reads the arguments. The exit code where the program ends with that: help and the
/// version were asked for, the usage is bad, or CLOTHLAB_INSTRUCTION_SET names a set that cannot be used.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

CLI::Option* add_scene(CLI::App& command, std::string& scene);                     ///< SCENE
CLI::Option* add_settings(CLI::App& command, std::vector<std::string>& settings);  ///< --set
CLI::Option* add_json(CLI::App& command, bool& json);
void add_overwrite(CLI::App& command, bool& overwrite);  ///< of an unfinished study

/// --shard of a study, which needs the folder of `out`.
CLI::Option* add_shard(CLI::App& command, std::string& shard, CLI::Option* out);

/// --jobs, 0 without it. `what`: "Cells that are run at once".
CLI::Option* add_jobs(CLI::App& command, int& jobs, const std::string& what);
/// What was asked for, or as many as there are cores.
int chosen_jobs(int jobs);

/// The part that was asked for, none for an empty text; or the exit code after a message.
std::variant<std::optional<cloth::Shard>, int> chosen_shard(const std::string& text);

/// An option that names a file or a folder. An empty name, as of a variable that is not set, is bad usage.
CLI::Option* add_path(CLI::App& command, const char* option, std::string& path, const std::string& help);

/// An option with names between commas, each of them among `known`.
CLI::Option* add_names(CLI::App& command, const char* option, std::vector<std::string>& names,
                       const std::string& help, const std::vector<std::string>& known);

}  // namespace clothlab::cli
