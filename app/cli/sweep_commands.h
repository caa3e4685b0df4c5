// The commands of a sweep's folder: status, merge, emit.
#pragma once

#include "parse.h"
#include "sweep/sweep_folder.h"

namespace clothlab::cli {

void add_sweep_commands(Program& program, CLI::App& sweep);

/// A sweep's folder, or the exit code after a message.
struct TakenFolder {
  std::optional<cloth::SweepFolder> folder;
  int exit_code = 0;
};

/// Makes the folder for the plan in a file, or takes the one that has it; without a plan, the one that is
/// there.
TakenFolder take_folder(const std::string& plan_file, const std::string& folder);

/// Writes sweep.csv and the report of what the folder has; says what is missing, and what does not agree.
int merge_folder(const cloth::SweepFolder& folder);

}  // namespace clothlab::cli
