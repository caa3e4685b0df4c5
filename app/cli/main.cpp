// clothlab-cli: the engine without Qt and without a display.
#include "commands.h"
#include "console.h"

namespace clothlab::cli {
namespace {

const char* const footer =
    "CLOTHLAB_INSTRUCTION_SET=portable, avx2 or avx512 in the environment makes the kernels use that "
    "instruction set instead of the processor's best.\n"
    "Exit codes: 0 done; 1 a defect of the program; 2 bad input or usage; 3 the run diverged (everything up "
    "to the last good state is "
    "on disk), or did not keep its deformation rate; "
    "4 a file could not be read or written, or there is not enough memory; 5 a replay did not end in its "
    "session's state; 6 measured values do not identify every parameter; 130 interrupted.";

int run_command(int argc, char** argv) {
  Program program{CLI::App(
      "Clothlab on the command line: runs and explains cloth simulation scenes, and studies their methods.",
      program_name)};
  program.app.require_subcommand(1);
  program.app.footer(footer);
  for (const auto add :
       {add_run, add_replay, add_scenes, add_materials, add_mesh, add_explain, add_compare,
        add_work_precision, add_stability, add_extremes, add_convergence, add_iterations, add_identify,
        add_study, add_sweep, add_reproduce, add_validate, add_schema, add_parameters})
    add(program);
  if (const auto ended = parse(program.app, argc, argv)) return *ended;
  return program.chosen();
}

}  // namespace

const char* const program_name = "clothlab-cli";

}  // namespace clothlab::cli

int main(int argc, char** argv) {
  return clothlab::cli::run_program([&] { return clothlab::cli::run_command(argc, argv); });
}
