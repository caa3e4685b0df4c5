#include "bridge/scene_run.h"

#include "scene/scene_checks.h"
#include "scene/scene_edits.h"

namespace clothlab {
namespace {

constexpr auto batch_time = std::chrono::milliseconds(5);  // between two looks at the inbox

}  // namespace

SceneRun::SceneRun(RunExchange& exchange, const cloth::Scene& scene, int threads, std::size_t max_history)
    : LiveRun(exchange),
      simulation_(std::make_unique<cloth::Simulation>(scene)),
      threads_(threads),
      history_(max_history) {
  history_.begin(*simulation_);
}

SceneRun::SceneRun(RunExchange& exchange, cloth::RunWithHistory run, int threads, std::size_t max_history)
    : LiveRun(exchange),
      simulation_(std::move(run.simulation)),
      threads_(threads),
      history_(std::move(run.history)) {
  history_.set_max_bytes(max_history);
}

void SceneRun::begin() {
  simulation_->set_threads(threads_);
  simulation_->set_stop_test([stop = exchange_.stop] { return stop.stop_requested(); });
  status().session_agrees.reset();
  status().divergence.reset();
  rows_ = cloth::RowClock::of(*simulation_);
  exchange_.begin_run(time());
  take_sample();
  publish_frames();
}

/// Of another scene the window asks for a new run.
bool SceneRun::acts_at_once(const cloth::Comparison& edited) const {
  const auto present = cloth::comparison_of_one(simulation_->scene(), cloth::no_reference);
  return cloth::is_scene(edited) || cloth::acts_at_once(present, edited);
}

std::string SceneRun::edit(const cloth::Comparison& edited) {
  const auto problems = try_to_perform(cloth::edits_between(simulation_->scene(), edited.scene));
  publish_frames();
  return problems.empty() ? "" : problems.front().text();
}

/// Carries out what the window asks for the way a replay will, and logs it.
std::vector<cloth::Problem> SceneRun::try_to_perform(const cloth::SessionAction& action) {
  if (cloth::is_idle(action, *simulation_)) return {};
  auto problems = cloth::carry_out(action, *simulation_);
  if (!problems.empty()) return problems;
  begin_branch();
  history_.log(action, *simulation_);
  rows_.follow(*simulation_);
  if (is_recording()) note_record(recording_.log(history_.commands().back()));
  return {};
}

/// Begins a new branch: deletes the history after the present step.
void SceneRun::begin_branch() {
  repeats_ = false;
  status().session_agrees.reset();
  if (history_.cut(*simulation_)) drop_later_samples();
}

/// Tells the charts, if they have been given any.
void SceneRun::drop_later_samples() {
  const std::int64_t step = simulation_->state().step;
  if (last_sampled_step_ <= step) return;
  last_sampled_step_ = step;
  energy_.cut(step);
  exchange_.deliver(ChartSample{.time_s = time(), .is_cut = true});
}

void SceneRun::prepare_to_play() {
  status().divergence.reset();
  repeats_ = false;
}

void SceneRun::single_step() {
  status().divergence.reset();
  if (advance(1)) publish_frames();
}

void SceneRun::start_recording(const std::filesystem::path& folder) {
  rows_.origin = simulation_->state().step;
  history_.keep(*simulation_);  // a divergence does not lead back to before the recording
  forget_cost();
  note_record(recording_.begin(folder, *simulation_));
}

void SceneRun::keep_recording_current() {
  if (is_recording()) note_record(recording_.keep_current(!status().playing));
}

std::optional<cloth::IoError> SceneRun::close_recording() {
  status().recorded_rows = recording_.rows();
  return recording_.end(*simulation_, simulation_->state(), status().divergence);
}

/// Steps that are due, for a few milliseconds at most; then a frame, if the last one is old enough.
void SceneRun::play_for_a_moment() {
  const Clock::time_point start = Clock::now();
  Clock::time_point now = start;
  do {
    const std::int64_t due = steps_due(now), begin = simulation_->state().step;
    if (due == 0 || !advance(due)) break;
    now = Clock::now();
    exchange_.meter.count(simulation_->state().step - begin, time(), now);
  } while (now - start < batch_time && !stop_requested());
  if (now - last_frame_ >= frame_interval) publish_frames();
}

/// Those between which nothing is looked at: to the next row at most, and one by one where the log is played
/// again. 0: none is due.
std::int64_t SceneRun::steps_due(Clock::time_point now) {
  const double time = simulation_->time(), step = simulation_->time_step();
  if (!exchange_.pace.is_due(time + step, now)) return 0;
  const std::int64_t most =
      repeats_ ? 1 : std::min(batch_.steps(), rows_.until_due(simulation_->state().step));
  std::int64_t steps = 1;
  while (steps < most && exchange_.pace.due_time(time + static_cast<double>(steps + 1) * step) <= now)
    ++steps;
  return steps;
}

bool SceneRun::advance(std::int64_t steps) {
  if (repeats_) return advance_again();
  begin_branch();
  const std::int64_t begin = simulation_->state().step;
  const Clock::time_point start = Clock::now();
  const auto divergence = simulation_->advance(steps);
  const double taken = seconds(Clock::now() - start);
  wall_since_row_ += taken;
  if (divergence) {
    diverge(*divergence);
    return false;
  }
  if (simulation_->interrupted()) return false;
  history_.extend(*simulation_);
  steps_since_row_ += simulation_->state().step - begin;
  batch_.note(steps, taken);
  sample_if_due();
  return true;
}

void SceneRun::sample_if_due() {
  rows_.follow(*simulation_);
  if (rows_.due(simulation_->state().step)) take_sample();
}

void SceneRun::forget_cost() {
  wall_since_row_ = 0;
  steps_since_row_ = 0;
}

void SceneRun::take_sample() {
  const cloth::Measurement m = simulation_->measure();
  history_.keep(*simulation_);
  ChartSample sample{.time_s = m.time,
                     .kinetic_J = m.energy.kinetic,
                     .elastic_J = m.energy.elastic,
                     .gravity_J = m.energy.gravity,
                     .total_J = m.energy.total(),
                     .max_strain = m.strain.maximum()};
  if (!m.probes.empty()) {
    const std::vector<std::string>& columns = simulation_->probes().columns();
    if (!probe_columns_ || *probe_columns_ != columns)
      probe_columns_ = std::make_shared<const std::vector<std::string>>(columns);
    sample.probe_columns = probe_columns_;
    sample.probes = m.probes;
  }
  if (steps_since_row_ > 0) sample.step_ms = 1e3 * wall_since_row_ / static_cast<double>(steps_since_row_);
  if (is_recording()) note_record(recording_.add_row(*simulation_, m, wall_since_row_, steps_since_row_));
  forget_cost();

  if (m.step <= last_sampled_step_) return;  // on the way through the history
  last_sampled_step_ = m.step;
  energy_.add(m);
  if (m.step == 0) {
    first_sample_ = sample;
    return;
  }
  if (first_sample_) exchange_.deliver(*first_sample_);
  first_sample_.reset();
  exchange_.deliver(sample);
}

/// The view keeps the last good state, and so does the simulation: after an edit it can go on from there.
void SceneRun::diverge(const cloth::Divergence& divergence) {
  status().divergence = divergence;
  ++status().divergences;
  status().playing = false;
  repeats_ = false;
  history_.return_from(divergence, *simulation_);
  drop_later_samples();
  end_recording();
  rows_.follow(*simulation_);
  rows_.origin = simulation_->state().step;
  ++status().jumps;
  publish_frames();
}

void SceneRun::publish_frames() {
  publish_frame(0, *simulation_, simulation_->state(), exchange_.contact);
  last_frame_ = Clock::now();
}

void SceneRun::fill_status(WorkerStatus& status) {
  status.time = time();
  status.step = simulation_->state().step;
  status.time_step = simulation_->time_step();
  status.notice = notice();
  const cloth::Scene& scene = simulation_->scene();
  if (!status.comparison || status.is_comparison() || status.comparison->scene != scene)
    status.comparison = std::make_shared<const cloth::Comparison>(content());
  status.history = {.last_step = history_.last_step(),
                    .last_time = history_.last_time(),
                    .states = history_.state_count(),
                    .bytes = history_.bytes(),
                    .max_bytes = history_.max_bytes(),
                    .marks = marks_.of(history_, scene)};
  if (is_recording()) status.recorded_rows = recording_.rows();
}

/// What the user has to know about the quality of the run, a line each.
std::string SceneRun::notice() const {
  std::string notice;
  for (const std::string& of_scene : cloth::scene_notices(simulation_->scene())) notice += of_scene + '\n';
  if (const auto& unreachable = simulation_->unreachable_rate())
    notice += cloth::describe(*unreachable, simulation_->system()) + '\n';
  if (auto breach = simulation_->rate_breach()) {
    breach->steps = 1;  // a notice that does not change with every step
    notice += cloth::describe(*breach) + '\n';
  }
  if (const std::string of_steps = cloth::describe(simulation_->count()); !of_steps.empty())
    notice += of_steps + '\n';
  notice += energy_.notice();
  if (notice.ends_with('\n')) notice.pop_back();
  return notice;
}

}  // namespace clothlab
