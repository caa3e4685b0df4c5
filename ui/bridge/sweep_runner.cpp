#include "bridge/sweep_runner.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cassert>

#include "bridge/worker_pace.h"
#include "io/process.h"
#include "sweep/merge_sweep.h"

namespace clothlab {
namespace {

constexpr int sweep_priority = 10;  // of nice(2): the simulation and the window go first

std::string why_refused(const cloth::SweepFolderReading& reading) {
  if (reading.error) return reading.error->text();
  std::string text;
  for (const cloth::Problem& problem : reading.problems) text += (text.empty() ? "" : "; ") + problem.text();
  return text;
}

}  // namespace

SweepRunner::~SweepRunner() {
  cancel();
  wait();
}

void SweepRunner::start(SweepOrder order, int jobs) {
  assert(!is_running());
  wait();
  start_ = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    status_ = {};
    status_.running = true;
    earlier_ = -1;
  }
  thread_ = std::jthread(
      [this, order = std::move(order), jobs](const std::stop_token& stop) { run(order, jobs, stop); });
}

void SweepRunner::cancel() {
  {
    const std::lock_guard lock(mutex_);
    status_.stopping = status_.running;
  }
  thread_.request_stop();
}

void SweepRunner::wait() {
  if (thread_.joinable()) thread_.join();
}

SweepStatus SweepRunner::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void SweepRunner::note(std::int64_t done, std::int64_t points) {
  const std::lock_guard lock(mutex_);
  if (earlier_ < 0) earlier_ = done;
  status_.done = done;
  status_.points = points;
  status_.elapsed = seconds(Clock::now() - start_);
  const std::int64_t made = done - earlier_;
  status_.left.reset();
  if (made > 0)
    status_.left = status_.elapsed * static_cast<double>(points - done) / static_cast<double>(made);
}

void SweepRunner::run(const SweepOrder& order, int jobs, const std::stop_token& stop) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), sweep_priority);  // its threads inherit it
  std::string problem;
  try {
    problem = carry_out(order, jobs, stop);
  } catch (...) {
    problem = cloth::failure_in_hand().text;
  }
  const std::lock_guard lock(mutex_);
  status_.problem = std::move(problem);
  status_.running = status_.stopping = status_.writing = false;
  status_.elapsed = seconds(Clock::now() - start_);
  status_.left.reset();
}

/// What went wrong; empty: nothing.
std::string SweepRunner::carry_out(const SweepOrder& order, int jobs, const std::stop_token& stop) {
  const cloth::SweepFolderReading reading = order.plan ? cloth::take_sweep_folder(order.folder, *order.plan)
                                                       : cloth::resume_sweep_folder(order.folder);
  if (!reading.folder) return why_refused(reading);
  cloth::SweepRunOptions options{.jobs = jobs};
  options.stop = [&stop] { return stop.stop_requested(); };
  options.progress = [this](std::int64_t done, std::int64_t points) { note(done, points); };
  const cloth::SweepRun run = run_sweep(*reading.folder, options);
  if (run.error) return run.error->text();
  note(run.earlier + run.made, run.points);
  if (!run.is_complete()) return {};
  {
    const std::lock_guard lock(mutex_);
    status_.writing = true;
  }
  const cloth::ShardFiles files = cloth::read_shard_files(*reading.folder);
  if (files.error) return files.error->text();
  const cloth::SweepResults results = cloth::sweep_results(*reading.folder, files.files);
  if (!results.disagreements.empty()) return results.disagreements.front().text;
  const auto error = write_merged(*reading.folder, results);
  return error ? error->text() : "";
}

}  // namespace clothlab
