// How a program of the command line reads its arguments.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace clothlab::cli {

/// Adds --version and reads the arguments. The exit code where the program ends with that: help and the
/// version were asked for, the usage is bad, or CLOTHLAB_INSTRUCTION_SET names a set that cannot be used.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

/// For options that name a file: an empty name, as of a variable that is not set, is bad usage.
CLI::Validator is_name();

}  // namespace clothlab::cli
