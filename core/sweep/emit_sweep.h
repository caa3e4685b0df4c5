// Scripts by which schedulers and their like run a sweep's shards. All of them start the same command, "part
// I of N", and what it has made is skipped when it is started again.
#pragma once

#include <string>
#include <vector>

#include "sweep/sweep_results.h"

namespace cloth {

/// "slurm", "parallel", "snakemake"
enum class EmitTarget { slurm, parallel, snakemake };
const std::vector<std::string>& emit_target_names();

struct EmitOptions {
  EmitTarget target = EmitTarget::slurm;
  std::int64_t shards = 1;
  int at_once = 0;  ///< tasks that may run at the same time; 0: as many as there is room for
  int jobs = 1;     ///< points at once within a task: processors of each
  std::string program = "clothlab-cli";
};

struct EmittedFile {
  std::string name{};  ///< in the sweep's folder
  std::string text{};
  bool is_program = false;  ///< to be started by a person
};

/// The files in the order in which they are of interest: the first one is what is started. Precondition:
/// `folder.path` is absolute.
std::vector<EmittedFile> emitted_files(const SweepFolder& folder, const EmitOptions& options);

/// Shards by which a task takes some `task` seconds where a point takes `point` seconds of one processor and
/// `jobs` are run at once.
std::int64_t packed_shards(std::int64_t points, double point, int jobs, double task);

/// In quotes for a shell.
std::string shell_quoted(const std::string& text);

}  // namespace cloth
