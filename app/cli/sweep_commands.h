// The commands of a sweep's folder: status, merge, emit.
#pragma once

#include "parse.h"
#include "sweep/sweep_folder.h"

namespace clothlab::cli {

void add_sweep_commands(Program& program, CLI::App& sweep);

/// Writes sweep.csv and the report of what the folder has; says what is missing, and what does not agree.
int merge_folder(const cloth::SweepFolder& folder);

}  // namespace clothlab::cli
