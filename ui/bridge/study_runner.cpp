#include "bridge/study_runner.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cassert>

#include "bridge/worker_pace.h"
#include "io/process.h"
#include "simulation/step_batches.h"

namespace clothlab {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds between_offers{100};
constexpr int low_priority = 10;  // of nice(2): the simulation and the window go first

/// Without the states of the reference, which no diagram needs.
cloth::WorkPrecision copy_of(const cloth::WorkPrecision& study) {
  const cloth::ReferenceSolution& from = study.reference;
  cloth::WorkPrecision copy;
  copy.scene = study.scene;
  copy.particles = study.particles;
  copy.diagonal = study.diagonal;
  copy.horizon = study.horizon;
  copy.samples = study.samples;
  copy.repeats = study.repeats;
  copy.steps_per_method = study.steps_per_method;
  copy.budget = study.budget;
  copy.estimated = study.estimated;
  copy.reference = {{},         from.floor,  from.excited_frequency, from.largest_kinetic, from.smooth,
                    from.first, from.second, from.evaluations,       from.failure};
  copy.methods = study.methods;
  copy.stopped = study.stopped;
  return copy;
}

cloth::StabilityMap copy_of(const cloth::StabilityMap& map) {
  return map;
}

cloth::ExtremesTable copy_of(const cloth::ExtremesTable& table) {
  return table;
}

cloth::ValidationStudy copy_of(const cloth::ValidationStudy& study) {
  return study;
}

cloth::GridConvergence copy_of(const cloth::GridConvergence& study) {
  return study;
}

cloth::IterationsStudy copy_of(const cloth::IterationsStudy& study) {
  return study;
}

/// A table that is not the last one is that of a study which is not complete.
void mark(cloth::WorkPrecision& study) {
  study.stopped = true;
}
void mark(cloth::StabilityMap& map) {
  map.complete = false;
}
void mark(cloth::ExtremesTable&) {}
void mark(cloth::GridConvergence&) {}
void mark(cloth::ValidationStudy&) {}
void mark(cloth::IterationsStudy& study) {
  study.stopped = true;
}

}  // namespace

StudyRunner::~StudyRunner() {
  cancel();
  wait();
}

void StudyRunner::start(StudyOrder order) {
  assert(!is_running() || status().writing);
  std::erase_if(jobs_, [](const std::unique_ptr<Job>& job) { return job->ended.load(); });
  Job& job = *jobs_.emplace_back(std::make_unique<Job>());
  job.order = std::move(order);
  job.start = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    status_ = {};
    status_.running = true;
    present_ = &job;
    newest_.reset();
  }
  job.thread = std::jthread([this, &job](const std::stop_token& stop) { run(job, stop); });
}

void StudyRunner::cancel() {
  {
    const std::lock_guard lock(mutex_);
    status_.stopping = status_.running;
  }
  if (!jobs_.empty()) jobs_.back()->thread.request_stop();
}

void StudyRunner::wait() {
  for (const std::unique_ptr<Job>& job : jobs_)
    if (job->thread.joinable()) job->thread.join();
}

StudyStatus StudyRunner::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool StudyRunner::is_running() const {
  const std::lock_guard lock(mutex_);
  return status_.running;
}

std::shared_ptr<const cloth::StudyTable> StudyRunner::take() {
  const std::lock_guard lock(mutex_);
  return std::move(newest_);
}

bool StudyRunner::note(const Job& job, const cloth::StudyProgress& progress) {
  const std::lock_guard lock(mutex_);
  status_.fraction = progress.fraction;
  status_.text = progress.text;
  status_.elapsed = seconds(Clock::now() - job.start);
  status_.left.reset();
  if (progress.fraction > 0.02) status_.left = status_.elapsed * (1 - progress.fraction) / progress.fraction;
  return !status_.stopping;
}

void StudyRunner::note_problem(const Job& job, const std::string& problem) {
  const std::lock_guard lock(mutex_);
  if (&job == present_)
    status_.problem = problem;
  else if (!problem.empty())
    status_.earlier_problem = problem;
}

/// What is finished is on disk at once; the window sees it some ten times a second.
template <class Table>
void StudyRunner::offer(Job& job, const Table& table) {
  const auto now = Clock::now();
  if (job.recorder.is_open() && status().problem.empty())  // a study goes on without its folder
    if (const auto error = job.recorder.keep(table)) note_problem(job, error->text());
  if (now - job.offered < between_offers) return;
  job.offered = now;
  Table copy = copy_of(table);
  mark(copy);
  show(job, std::move(copy));
}

/// The whole table is seen before it is written, which may take long. It is written even where a finished
/// run could not be.
template <class Table>
void StudyRunner::end(Job& job, const Table& table) {
  show(job, copy_of(table));
  if (!job.recorder.is_open()) return;
  const double elapsed = seconds(Clock::now() - job.start);
  {
    const std::lock_guard lock(mutex_);
    status_.writing = true;
    status_.text = "writing the results";
    status_.left.reset();
  }
  const auto error = job.recorder.end(table, elapsed);
  note_problem(job, error ? error->text() : "");
}

template <class Table>
void StudyRunner::show(const Job& job, Table table) {
  auto shared = std::make_shared<const cloth::StudyTable>(std::move(table));
  const std::lock_guard lock(mutex_);
  if (&job == present_) newest_ = std::move(shared);
}

/// The unfinished study of the same kind and inputs that the folder holds, or null.
template <class Table>
const Table* StudyRunner::begin(Job& job, const Table& plan) {
  const auto error = job.recorder.begin(job.order.folder, plan, {.command = job.order.command});
  if (error) note_problem(job, error->text());
  return job.recorder.earlier() ? &std::get<Table>(*job.recorder.earlier()) : nullptr;
}

void StudyRunner::run(Job& job, const std::stop_token& stop) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), low_priority);
  job.offered = Clock::now();
  std::string problem;
  try {
    carry_out(job, stop);
  } catch (...) {
    problem = cloth::failure_in_hand().text;
  }
  if (!problem.empty()) note_problem(job, problem);
  job.ended = true;
  const std::lock_guard lock(mutex_);
  if (&job != present_) return;
  status_.running = status_.stopping = status_.writing = false;
  status_.elapsed = seconds(Clock::now() - job.start);
  status_.left.reset();
  if (!stop.stop_requested() && problem.empty()) status_.fraction = 1;
}

void StudyRunner::carry_out(Job& job, const std::stop_token& stop) {
  const StudyOrder& order = job.order;
  const auto study = [&](auto options, const auto& plan, const auto& run) {
    options.progress = [&](const cloth::StudyProgress& now) { return note(job, now); };
    options.partial = [&](const auto& table) { offer(job, table); };
    options.stop = [&stop] { return stop.stop_requested(); };
    if constexpr (requires { options.jobs; }) options.jobs = cloth::machine_threads();
    options.earlier = begin(job, plan(options));
    end(job, run(options));
  };
  if (const auto* precision = std::get_if<cloth::WorkPrecisionOptions>(&order.options)) {
    study(
        *precision, [&](const auto& o) { return cloth::plan_work_precision(order.scene, o); },
        [&](const auto& o) { return cloth::study_work_precision(order.scene, o); });
  } else if (const auto* map = std::get_if<cloth::StabilityOptions>(&order.options)) {
    note(job, {0, "laying out the map"});
    study(
        *map, [&](const auto& o) { return cloth::plan_stability_map(order.scene, o); },
        [&](const auto& o) { return cloth::run_stability_map(order.scene, o); });
  } else if (const auto* grids = std::get_if<cloth::GridConvergenceOptions>(&order.options)) {
    study(
        *grids, [&](const auto& o) { return cloth::plan_grid_convergence(order.scene, o); },
        [&](const auto& o) { return cloth::run_grid_convergence(order.scene, o); });
  } else if (const auto* validation = std::get_if<cloth::ValidationOptions>(&order.options)) {
    study(*validation, cloth::plan_validation, cloth::run_validation);
  } else if (const auto* iterations = std::get_if<cloth::IterationsOptions>(&order.options)) {
    note(job, {0, "moving the scene up to the step that is studied"});
    study(
        *iterations, [&](const auto& o) { return cloth::plan_iterations_study(order.scene, o); },
        [&](const auto& o) { return cloth::run_iterations_study(order.scene, o); });
  } else {
    study(std::get<cloth::ExtremesOptions>(order.options), cloth::empty_table, cloth::run_extremes);
  }
}

}  // namespace clothlab
