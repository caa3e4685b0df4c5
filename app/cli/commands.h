// The commands, a file each, which adds itself to the program with its options.
#pragma once

#include "parse.h"

namespace clothlab::cli {

void add_run(Program& program);
void add_replay(Program& program);
void add_scenes(Program& program);
void add_materials(Program& program);
void add_mesh(Program& program);
void add_explain(Program& program);
void add_compare(Program& program);
void add_work_precision(Program& program);
void add_stability(Program& program);
void add_extremes(Program& program);
void add_convergence(Program& program);
void add_identify(Program& program);
void add_iterations(Program& program);
void add_study(Program& program);
void add_sweep(Program& program);
void add_reproduce(Program& program);
void add_validate(Program& program);
void add_schema(Program& program);
void add_parameters(Program& program);

}  // namespace clothlab::cli
