#include "sweep/emit_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

/// What all scripts begin with: the same engine, bits and folder whatever machine they run on.
std::string shell_head(const SweepFolder& folder, const EmitOptions& options) {
  return fmt::format("program={}\nfolder={}\nshards={}\nexport {}={}\n", shell_quoted(options.program),
                     shell_quoted(folder.path.string()), options.shards, instruction_set_variable,
                     folder.instruction_set);
}

std::string slurm_task(const SweepFolder& folder, const EmitOptions& options) {
  return fmt::format(R"END(#!/bin/sh
# One shard of the sweep: submit.sh hands this to sbatch. $1 is added to the index of the array task.
#SBATCH --job-name=clothlab-sweep
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={0}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
{1}
# A minute before the time limit Slurm signals this shell alone.
trap 'kill -TERM "$child" 2>/dev/null' TERM
"$program" sweep --out "$folder" --shard "auto+$1/$shards" --jobs {0} &
child=$!
wait "$child"
code=$?
# A signal ends the wait before the program has ended.
while kill -0 "$child" 2>/dev/null; do
  wait "$child"
  code=$?
done
exit "$code"
)END",
                     options.jobs, shell_head(folder, options));
}

std::string slurm_merge(const SweepFolder& folder, const EmitOptions& options) {
  return fmt::format(R"END(#!/bin/sh
# Merges what the tasks have made: submit.sh lets it run after them, however they ended.
#SBATCH --job-name=clothlab-sweep-merge
#SBATCH --ntasks=1
#SBATCH --open-mode=append
{}
exec "$program" sweep merge "$folder"
)END",
                     shell_head(folder, options));
}

std::string slurm_submit(const SweepFolder& folder, const EmitOptions& options) {
  return fmt::format(R"END(#!/bin/sh
# Submits the shards that are not complete, and a merge after them. Options go to every sbatch:
#     sh submit.sh --partition=short --time=30
# Started again after the tasks have ended it submits what is missing then.
set -eu
{0}at_once={1}
scripts=$folder/slurm

# The largest index of an array is one less than MaxArraySize.
most=$(scontrol show config | awk '$1 == "MaxArraySize" {{ print $3 }}')
case $most in '' | *[!0-9]*) most=1001 ;; esac
most=$((most - 1))
arrays=$(((shards + most - 1) / most))
limit=
[ "$at_once" -eq 0 ] || limit=%$(((at_once + arrays - 1) / arrays))

jobs=
offset=0
while [ "$offset" -lt "$shards" ]; do
  missing=$("$program" sweep status "$folder" --missing --shards "$shards" --after "$offset" --at-most "$most")
  if [ -n "$missing" ]; then
    job=$(sbatch --parsable --array="$missing$limit" --output="$scripts/log/%A_%a.txt" "$@" \
      "$scripts/task.sh" "$offset") || {{
      echo "submit.sh: sbatch refused the shards after $offset; submitted before: ${{jobs:-none}}" >&2
      exit 1
    }}
    job=${{job%%;*}}
    echo "job $job: shards $missing after $offset"
    jobs=$jobs:$job
  fi
  offset=$((offset + most))
done

if [ -z "$jobs" ]; then
  echo "no shard lacks a point"
  exec "$program" sweep merge "$folder"
fi
job=$(sbatch --parsable --dependency="afterany$jobs" --output="$scripts/log/merge-%j.txt" "$@" \
  "$scripts/merge.sh") || {{
  echo "submit.sh: sbatch refused the merge; the shards are submitted: $jobs" >&2
  exit 1
}}
echo "job ${{job%%;*}}: the merge, after them"
)END",
                     shell_head(folder, options), options.at_once);
}

std::string parallel_script(const SweepFolder& folder, const EmitOptions& options) {
  return fmt::format(R"END(#!/bin/sh
# Runs the shards by GNU parallel, and merges. Options go to parallel:
#     sh run.sh --sshloginfile nodes
set -eu
{0}
seq "$shards" | parallel --quote {1}--halt never --termseq TERM,2000,KILL,200 --env {3} "$@" \
  "$program" sweep --out "$folder" --shard "{{}}/$shards" --jobs {2} || echo "run.sh: some shards failed" >&2
exec "$program" sweep merge "$folder"
)END",
                     shell_head(folder, options),
                     options.at_once > 0 ? fmt::format("--jobs {} ", options.at_once)
                                         : std::string(options.jobs > 1 ? "--jobs 1 " : ""),
                     options.jobs, instruction_set_variable);
}

/// A text of Snakemake's, in which braces have a meaning.
std::string snakemake_text(const std::string& text) {
  std::string doubled;
  for (const char c : text) doubled += (c == '{' || c == '}') ? std::string(2, c) : std::string(1, c);
  return doubled;
}

std::string snakefile(const SweepFolder& folder, const EmitOptions& options) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  const std::string start = snakemake_text(fmt::format(
      "{}={} {} sweep", instruction_set_variable, folder.instruction_set, shell_quoted(options.program)));
  const std::string place = snakemake_text(shell_quoted(folder.path.string()));
  return fmt::format(R"END(# Runs the shards by Snakemake, and merges:
#     snakemake --snakefile {3} --cores 8
workdir: {0}

shards = {1}

rule all:
    input: "sweep.csv"

rule shard:
    output: touch("snakemake/done/{{shard}}-of-{1}")
    threads: {2}
    shell: {4}

rule merge:
    input: expand("snakemake/done/{{shard}}-of-{1}", shard=range(1, shards + 1))
    output: "sweep.csv"
    shell: {5}
)END",
                     quoted(folder.path.string()), options.shards, options.jobs,
                     shell_quoted((folder.path / "snakemake/Snakefile").string()),
                     quoted(fmt::format("{} --out {} --shard {{wildcards.shard}}/{} --jobs {{threads}}",
                                        start, place, options.shards)),
                     quoted(fmt::format("{} merge {}", start, place)));
}

}  // namespace

const std::vector<std::string>& emit_target_names() {
  static const std::vector<std::string> names{"slurm", "parallel", "snakemake"};
  return names;
}

std::vector<EmittedFile> emitted_files(const SweepFolder& folder, const EmitOptions& options) {
  switch (options.target) {
    case EmitTarget::slurm:
      return {{"slurm/submit.sh", slurm_submit(folder, options), true},
              {"slurm/task.sh", slurm_task(folder, options)},
              {"slurm/merge.sh", slurm_merge(folder, options)}};
    case EmitTarget::parallel:
      return {{"parallel/run.sh", parallel_script(folder, options), true}};
    default:
      return {{"snakemake/Snakefile", snakefile(folder, options)}};
  }
}

std::int64_t packed_shards(std::int64_t points, double point, int jobs, double task) {
  const double of_task = std::max(1.0, std::floor(task * jobs / std::max(point, 1e-6)));
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(static_cast<double>(points) / of_task)),
                                  1, std::max<std::int64_t>(1, points));
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace cloth
