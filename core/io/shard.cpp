#include "io/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace cloth {
namespace {

constexpr std::int64_t most_shards = 100'000'000;

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || stop != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

/// What a scheduler says of an array job, by the names of its variables; "" where it has none.
struct Scheduler {
  const char *name, *index, *first, *last, *step;
};
constexpr Scheduler schedulers[] = {
    {"Slurm", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP"},
    {"PBS", "PBS_ARRAY_INDEX", "", "", ""},
    {"PBS", "PBS_ARRAYID", "", "", ""},
    {"SGE", "SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE"},
    {"LSF", "LSB_JOBINDEX", "", "LSB_JOBINDEX_END", "LSB_JOBINDEX_STEP"},
    {"GNU parallel", "PARALLEL_SEQ", "", "", ""}};

/// An array task's index, and the array's first and last where the scheduler tells them.
struct Task {
  const char* scheduler = "";
  std::int64_t index = 0;
  std::optional<std::int64_t> first{}, last{};
  std::int64_t step = 1;
  std::int64_t tasks = 0;  ///< of Slurm's array; 0: not known
};

std::optional<Task> task_of(const Environment& environment) {
  const auto number = [&](const char* name) {
    return *name ? whole_number(environment(name)) : std::optional<std::int64_t>();
  };
  for (const Scheduler& scheduler : schedulers) {
    const auto index = number(scheduler.index);
    // Outside of arrays SGE says "undefined", and LSF 0.
    if (!index || (*index == 0 && scheduler.name == std::string("LSF"))) continue;
    Task task{.scheduler = scheduler.name, .index = *index};
    task.first = number(scheduler.first);
    task.last = number(scheduler.last);
    if (scheduler.name == std::string("LSF")) task.first = 1;
    task.step = number(scheduler.step).value_or(1);
    if (scheduler.name == std::string("Slurm")) task.tasks = number("SLURM_ARRAY_TASK_COUNT").value_or(0);
    return task;
  }
  return std::nullopt;
}

/// The whole shard from an array that has no gaps.
std::variant<Shard, std::string> shard_of_array(const Task& task) {
  if (!task.first || !task.last)
    return fmt::format("{} does not say how many tasks there are: give the number, as in auto/400",
                       task.scheduler);
  const std::int64_t count = *task.last - *task.first + 1;
  if (task.step != 1 || *task.first < 0 || *task.first > 1 || (task.tasks > 0 && task.tasks != count))
    return fmt::format(
        "the array of {} has gaps or does not begin at 0 or 1: give the number, as in auto/400",
        task.scheduler);
  return Shard{task.index - *task.first + 1, count};
}

}  // namespace

std::variant<Shard, Problem> shard_from(const std::string& text, const Environment& environment) {
  const auto bad = [&](const std::string& rule) { return Problem{"", text, rule, "--shard"}; };
  const auto slash = text.find('/');
  std::string index_text = text.substr(0, slash);
  Shard shard;
  const bool has_count = slash != std::string::npos;
  if (has_count) {
    const auto count = whole_number(text.substr(slash + 1));
    if (!count || *count < 1 || *count > most_shards)
      return bad(fmt::format("must be I/N with N from 1 to {}", most_shards));
    shard.count = *count;
  }
  if (index_text.rfind("auto", 0) == 0) {
    const auto task = task_of(environment);
    if (!task)
      return bad(
          "needs the environment of an array job (SLURM_ARRAY_TASK_ID and its like), which is not set");
    if (!has_count) {
      if (index_text != "auto") return bad("must be I/N, auto/N, auto+OFFSET/N or auto");
      const auto whole = shard_of_array(*task);
      if (const auto* rule = std::get_if<std::string>(&whole)) return bad(*rule);
      return std::get<Shard>(whole);
    }
    shard.index = task->index;
    if (index_text.size() > 4) {
      const auto offset =
          index_text[4] == '+' ? whole_number(index_text.substr(5)) : std::optional<std::int64_t>();
      if (!offset || *offset < 0 || *offset > most_shards) return bad("must be auto+OFFSET/N");
      shard.index += *offset;
    }
  } else {
    const auto index = whole_number(index_text);
    if (!index || !has_count) return bad("must be I/N, auto/N, auto+OFFSET/N or auto");
    shard.index = *index;
  }
  if (shard.index < 1 || shard.index > shard.count)
    return bad(fmt::format("the index {} must be 1 to {}", shard.index, shard.count));
  return shard;
}

}  // namespace cloth
