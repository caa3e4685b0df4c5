#include "bridge/study_runner.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cassert>

#include "bridge/worker_pace.h"
#include "io/process.h"

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

/// A table that is not the last one is that of a study which is not complete.
void mark(cloth::WorkPrecision& study) {
  study.stopped = true;
}
void mark(cloth::StabilityMap& map) {
  map.complete = false;
}
void mark(cloth::ExtremesTable&) {}

}  // namespace

StudyRunner::~StudyRunner() {
  cancel();
  wait();
}

void StudyRunner::start(StudyOrder order) {
  assert(!is_running());
  wait();
  {
    const std::lock_guard lock(mutex_);
    status_ = {};
    status_.running = true;
    start_ = Clock::now();
    newest_.reset();
  }
  thread_ = std::jthread([this, order = std::move(order)](const std::stop_token& stop) { run(order, stop); });
}

void StudyRunner::cancel() {
  {
    const std::lock_guard lock(mutex_);
    status_.stopping = status_.running;
  }
  thread_.request_stop();
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

bool StudyRunner::note(const cloth::StudyProgress& progress) {
  const std::lock_guard lock(mutex_);
  status_.fraction = progress.fraction;
  status_.text = progress.text;
  status_.elapsed = seconds(Clock::now() - start_);
  status_.left.reset();
  if (progress.fraction > 0.02) status_.left = status_.elapsed * (1 - progress.fraction) / progress.fraction;
  return !status_.stopping;
}

/// What is finished is on disk at once; the window sees it some ten times a second.
template <class Table>
void StudyRunner::offer(const Table& table, bool last) {
  const auto now = Clock::now();
  if (recorder_.is_open()) keep(table, last);
  if (!last && now - offered_ < between_offers) return;
  offered_ = now;
  Table copy = copy_of(table);
  if (!last) mark(copy);
  const auto shared = std::make_shared<const cloth::StudyTable>(std::move(copy));
  const std::lock_guard lock(mutex_);
  newest_ = shared;
}

/// A study goes on without its folder: its table is on the screen, and its end is written if that can be done
/// by then.
template <class Table>
void StudyRunner::keep(const Table& table, bool last) {
  double elapsed = 0;
  {
    const std::lock_guard lock(mutex_);
    if (!last && !status_.problem.empty()) return;
    elapsed = seconds(Clock::now() - start_);
  }
  const auto error = last ? recorder_.end(table, elapsed) : recorder_.keep(table);
  const std::lock_guard lock(mutex_);
  status_.problem = error ? error->text() : "";
}

/// The unfinished study of the same kind and inputs that the folder holds, or null.
template <class Table>
const Table* StudyRunner::begin(const Table& plan, const StudyOrder& order) {
  if (const auto error = recorder_.begin(order.folder, plan, {.command = order.command})) {
    const std::lock_guard lock(mutex_);
    status_.problem = error->text();
  }
  return recorder_.earlier() ? &std::get<Table>(*recorder_.earlier()) : nullptr;
}

void StudyRunner::run(const StudyOrder& order, const std::stop_token& stop) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), low_priority);
  offered_ = Clock::now();
  std::string problem;
  try {
    carry_out(order, stop);
  } catch (...) {
    problem = cloth::failure_in_hand().text;
  }
  const std::lock_guard lock(mutex_);
  if (!problem.empty()) status_.problem = problem;
  status_.running = false;
  status_.stopping = false;
  status_.elapsed = seconds(Clock::now() - start_);
  status_.left.reset();
  if (!stop.stop_requested() && problem.empty()) status_.fraction = 1;
}

void StudyRunner::carry_out(const StudyOrder& order, const std::stop_token& stop) {
  const auto study = [&](auto options, const auto& plan, const auto& run) {
    options.progress = [this](const cloth::StudyProgress& now) { return note(now); };
    options.partial = [this](const auto& table) { offer(table, false); };
    options.stop = [&stop] { return stop.stop_requested(); };
    options.earlier = begin(plan(options), order);
    offer(run(options), true);
  };
  if (const auto* precision = std::get_if<cloth::WorkPrecisionOptions>(&order.options)) {
    study(
        *precision, [&](const auto& o) { return cloth::plan_work_precision(order.scene, o); },
        [&](const auto& o) { return cloth::study_work_precision(order.scene, o); });
  } else if (const auto* map = std::get_if<cloth::StabilityOptions>(&order.options)) {
    note({0, "laying out the map"});
    study(
        *map, [&](const auto& o) { return cloth::plan_stability_map(order.scene, o); },
        [&](const auto& o) { return cloth::run_stability_map(order.scene, o); });
  } else {
    study(std::get<cloth::ExtremesOptions>(order.options), cloth::empty_table, cloth::run_extremes);
  }
}

}  // namespace clothlab
