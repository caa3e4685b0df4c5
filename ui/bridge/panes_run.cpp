#include "bridge/panes_run.h"

#include <algorithm>

#include "compare/comparison_log.h"

namespace clothlab {

PanesRun::PanesRun(RunExchange& exchange, const cloth::Comparison& comparison, int threads)
    : LiveRun(exchange), lockstep_(std::make_unique<cloth::LockStep>(comparison)), threads_(threads) {}

PanesRun::PanesRun(RunExchange& exchange, const cloth::Comparison& comparison, int threads,
                   cloth::RunWithHistory run)
    : LiveRun(exchange), threads_(threads) {
  const cloth::Scene scene = run.simulation->scene();
  lockstep_ = std::make_unique<cloth::LockStep>(scene, std::move(run));
  lockstep_->edit(comparison);
}

void PanesRun::begin() {
  keep_history();
  exchange_.begin_run(time());
  take_sample(true);
  publish_frames();
}

void PanesRun::keep_history() {
  marks_ = {};
  lockstep_->keep_history(cloth::History::default_max_bytes);
  lockstep_->set_stop_test([stop = exchange_.stop] { return stop.stop_requested(); });
}

std::string PanesRun::edit(const cloth::Comparison& edited) {
  log(cloth::comparison_log_lines(lockstep_->comparison(), edited, time()));
  begin_branch();
  lockstep_->edit(edited);
  keep_history();
  publish_frames();
  return "";
}

void PanesRun::perform(const cloth::SessionAction& action) {
  const auto act = [&](const auto& hand, auto put_in_force) {
    log(cloth::comparison_log_lines(hand, time()));
    begin_branch();
    put_in_force(hand);
  };
  if (const auto* gust = std::get_if<std::optional<cloth::BrushGust>>(&action))
    act(*gust, [this](const auto& brush) { lockstep_->set_brush(brush); });
  if (const auto* pull = std::get_if<std::optional<cloth::Pull>>(&action))
    act(*pull, [this](const auto& hand) { lockstep_->set_pull(hand); });
}

void PanesRun::log(const std::vector<std::string>& lines) {
  if (recorder_) note_record(recorder_->log(lines));
}

void PanesRun::single_step() {
  begin_branch();
  under_way_ = lockstep_->index() + 1;
}

void PanesRun::start_recording(const std::filesystem::path& folder) {
  status().recorded_rows = 0;
  recorder_.emplace();
  note_record(recorder_->open(folder, *lockstep_));
  add_row();
}

void PanesRun::add_row() {
  if (!recorder_) return;
  note_record(recorder_->add_row(*lockstep_));
  ++status().recorded_rows;
}

void PanesRun::keep_recording_current() {
  if (!recorder_ || Clock::now() - last_flush_ < flush_interval) return;
  note_record(recorder_->flush());
  last_flush_ = Clock::now();
}

std::optional<cloth::IoError> PanesRun::close_recording() {
  auto error = recorder_->close();
  recorder_.reset();
  return error;
}

/// To the next common time, if it is due, or as far as it goes until there is a command.
void PanesRun::play_for_a_moment() {
  if (!under_way_) {
    if (!exchange_.pace.is_due(next_time(), Clock::now())) return;
    under_way_ = lockstep_->index() + 1;
  }
  const auto may_go_on = [this] { return !exchange_.has_mail() && !stop_requested(); };
  if (!lockstep_->advance(*under_way_, may_go_on, threads_)) return;
  under_way_.reset();
  arrive();
}

void PanesRun::arrive() {
  exchange_.meter.count(1, time(), Clock::now());
  if (lockstep_->all_stopped()) {
    status().playing = false;
    end_recording();
    publish_frames();
    return;
  }
  if (lockstep_->index() > last_sampled_) take_sample(false);
  add_row();
  if (lockstep_->index() == (repeats_ ? lockstep_->known_index() : lockstep_->last_index())) {
    status().playing = repeats_ = false;
    end_recording();
  }
  if (!status().playing || Clock::now() - last_frame_ >= frame_interval) publish_frames();
}

/// Shared by all samples while they stay the same.
std::shared_ptr<const std::vector<std::string>> PanesRun::columns_of(const cloth::Lane& lane) {
  const std::vector<std::string>& columns = lane.simulation->probes().columns();
  if (!probe_columns_ || *probe_columns_ != columns)
    probe_columns_ = std::make_shared<const std::vector<std::string>>(columns);
  return probe_columns_;
}

void PanesRun::take_sample(bool is_start) {
  CompareSample sample{.time_s = time(), .is_start = is_start};
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) {
    const cloth::Lane& lane = lockstep_->lane(i);
    if (!lane.going()) continue;
    const int style = style_of(lockstep_->comparison().panes[i]);
    PaneSample& pane = sample.panes[static_cast<std::size_t>(style)];
    pane.total_J = lane.measurement.energy.total();
    pane.max_strain = lane.measurement.strain.maximum();
    pane.probes = lane.measurement.probes;
    if (!pane.probes.empty()) sample.probe_columns = columns_of(lane);
    if (is_start && time() == 0) continue;  // no step was taken, and all panes are alike
    pane.step_ms = 1e3 * lane.step_time;
    if (const cloth::Difference* difference = lockstep_->difference(i)) pane.rms_m = difference->rms;
  }
  last_sampled_ = lockstep_->index();
  exchange_.deliver(sample);
}

void PanesRun::publish_frames() {
  static const std::vector<float> none;
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) {
    const cloth::Lane& lane = lockstep_->lane(i);
    // Contact is that of the simulation's own state, which a pane under way or stopped does not show.
    const bool shows_own_state = !under_way_ && lane.going();
    const cloth::Difference* difference = lockstep_->difference(i);
    publish_frame(i, *lane.simulation, lane.state, shows_own_state ? exchange_.contact : ContactChoice{},
                  exchange_.colouring == Colouring::strain ? nullptr
                  : difference                             ? &difference->distance
                                                           : &none);
  }
  last_frame_ = Clock::now();
}

void PanesRun::fill_status(WorkerStatus& status) {
  status.threads = threads_;
  status.time_step = status.steps_per_second = 0;
  if (under_way_) return;
  status.time = time();
  status.step = lockstep_->index();
  fill_history(status.history);
  status.duration = lockstep_->time_of(lockstep_->last_index());
  if (!status.comparison || *status.comparison != lockstep_->comparison())
    status.comparison = std::make_shared<cloth::Comparison>(lockstep_->comparison());
  status.panes = cloth::results_of(*lockstep_);
  status.reference = cloth::reference_text(*lockstep_);
  const auto reference = lockstep_->reference_lane();
  const bool failed = reference && !lockstep_->lane(*reference).going();
  status.reference_failure = failed ? cloth::describe(*lockstep_->lane(*reference).divergence) : "";
  status.floor = lockstep_->floor() ? std::optional(lockstep_->floor()->rms) : std::nullopt;
}

}  // namespace clothlab
