#include "bridge/simulation_worker.h"

#include <fmt/format.h>

#include "bridge/fill_frame.h"
#include "contact/start_check.h"
#include "io/process.h"
#include "scene/scene_checks.h"
#include "simulation/time_step.h"

namespace clothlab {
namespace {

constexpr auto batch_time = std::chrono::milliseconds(5);  // between two looks at the inbox

/// Why a scene cannot be run, or nothing.
std::string refusal_of(const cloth::Scene& scene) {
  if (const auto problems = cloth::find_problems(scene); !problems.empty()) return problems.front().text();
  if (!cloth::resolved_time_step(scene)) return cloth::no_stable_step_text(scene);
  return "";
}

/// A scene that is replaced before the next step need not be put in force: a slider moves faster than a big
/// cloth assembles.
bool is_overtaken_by(const Command& command, const Command& next) {
  return command.index() == next.index() &&
         command::is_one_of<command::Load<cloth::Scene>, command::Edit<cloth::Scene>, command::GoTo>(command);
}

}  // namespace

SimulationWorker::SimulationWorker(std::size_t max_history)
    : history_(max_history), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void SimulationWorker::run(const std::stop_token& stop) {
  yield_to_the_window();
  repeat(stop, [&] {
    const std::vector<Command> commands = wait_for_work(stop);
    try {
      carry_out(commands);
      if (status_.playing && !stop.stop_requested()) play_for_a_moment();
      if (recording_.is_active()) note_record(recording_.keep_current(!status_.playing));
    } catch (...) {
      give_up(cloth::failure_in_hand().text);
    }
    status_.commands += commands.size();
    publish_status();
    report_done(status_.commands, status_.playing);
  });
  end_recording();
}

void SimulationWorker::carry_out(const std::vector<Command>& commands) {
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (i + 1 == commands.size() || !is_overtaken_by(commands[i], commands[i + 1])) {
      batch_is_done_ = i + 1 == commands.size();
      std::visit([this](const auto& c) { handle(c); }, commands[i]);
    }
}

/// What was under way when memory ran out may be half done: there is no simulation until the next start.
void SimulationWorker::give_up(const std::string& why) {
  status_.playing = false;
  playing_again_ = false;
  status_.refusal = why;
  gave_up_ = true;
  end_recording();
  simulation_.reset();
}

/// Until there is a command, or the next step is due.
std::vector<Command> SimulationWorker::wait_for_work(const std::stop_token& stop) {
  if (!status_.playing) return receive(stop, std::nullopt);
  return receive(stop, pace_.due_time(simulation_->time() + simulation_->time_step()));
}

void SimulationWorker::handle(const command::Load<cloth::Scene>& load) {
  end_recording();
  if (start_simulation(load.content)) ++topology_;
  publish_frame();
}

void SimulationWorker::handle(const command::Restart&) {
  if (!simulation_) return;
  end_recording();
  const cloth::Scene scene = simulation_->scene();
  start_simulation(scene);
  publish_frame();
}

bool SimulationWorker::start_simulation(const cloth::Scene& scene) {
  status_.playing = false;
  status_.refusal = refusal_of(scene);
  if (status_.refusal.empty())
    if (const auto problems = cloth::find_start_problems(scene); !problems.empty())
      status_.refusal = problems.front().text();
  if (!status_.refusal.empty()) return false;
  simulation_ = std::make_unique<cloth::Simulation>(scene);
  history_.begin(*simulation_);
  begin_run();
  return true;
}

/// Of a simulation that is new here.
void SimulationWorker::begin_run() {
  simulation_->set_threads(std::max(1, cloth::machine_threads() - 1));  // one core is the window's
  simulation_->set_stop_test([this] { return thread_.get_stop_token().stop_requested(); });
  gave_up_ = false;
  playing_again_ = false;
  last_sampled_step_ = -1;
  first_sample_.reset();
  status_.session_agrees.reset();
  rows_ = cloth::RowClock::of(*simulation_);
  status_.divergence.reset();
  energy_ = {};
  wall_since_row_ = 0;
  steps_since_row_ = 0;
  restart_clock(simulation_->time());
  drop_samples();  // of the run before
  take_sample();
}

/// A run that stands still leaves nothing behind here but its status.
void SimulationWorker::handle(const command::GiveRun& give) {
  status_.playing = playing_again_ = false;
  end_recording();
  give.to->set_value({std::move(simulation_), std::exchange(history_, cloth::History(history_.max_bytes()))});
}

void SimulationWorker::handle(const command::TakeRun<cloth::Scene>& take) {
  cloth::RunWithHistory run = take.from->get();
  if (!run.simulation) return handle(command::Load{take.content});
  end_recording();
  status_.playing = false;
  simulation_ = std::move(run.simulation);
  history_ = std::move(run.history);
  history_.set_max_bytes(cloth::History::default_max_bytes);
  ++topology_;
  begin_run();
  handle(command::Edit{take.content});
}

void SimulationWorker::handle(const command::Edit<cloth::Scene>& edit) {
  if (gave_up_) return handle(command::Load{edit.content});
  if (!simulation_) return;
  status_.refusal = refusal_of(edit.content);
  if (!status_.refusal.empty()) return;
  const auto problems = perform(cloth::edits_between(simulation_->scene(), edit.content));
  if (!problems.empty()) status_.refusal = problems.front().text();
  publish_frame();
}

/// Carries out what the window asks for the way a replay will, and logs it.
std::vector<cloth::Problem> SimulationWorker::perform(const cloth::SessionAction& action) {
  if (!simulation_ || cloth::is_idle(action, *simulation_)) return {};
  auto problems = cloth::carry_out(action, *simulation_);
  if (!problems.empty()) return problems;
  begin_branch();
  history_.log(action, *simulation_);
  rows_.follow(*simulation_);
  if (recording_.is_active()) note_record(recording_.log(history_.commands().back()));
  return {};
}

/// Begins a new branch: deletes the history after the present step.
void SimulationWorker::begin_branch() {
  playing_again_ = false;
  status_.session_agrees.reset();
  if (history_.cut(*simulation_)) drop_later_samples();
}

/// Tells the charts, if they have been given any.
void SimulationWorker::drop_later_samples() {
  const std::int64_t step = simulation_->state().step;
  if (last_sampled_step_ <= step) return;
  last_sampled_step_ = step;
  energy_.cut(step);
  deliver({.time_s = simulation_->time(), .is_cut = true});
}

void SimulationWorker::handle(const command::Play&) {
  if (!simulation_ || !status_.refusal.empty()) return;
  status_.divergence.reset();
  status_.playing = true;
  playing_again_ = false;
  restart_clock(simulation_->time());
}

void SimulationWorker::handle(const command::Pause&) {
  status_.playing = false;
  publish_frame();  // what was computed since the last one
}

void SimulationWorker::handle(const command::SingleStep&) {
  status_.playing = false;
  if (!simulation_ || !status_.refusal.empty()) return;
  status_.divergence.reset();
  if (advance(1)) publish_frame();
}

void SimulationWorker::handle(const command::StartRecording& start) {
  if (!simulation_) return;
  end_recording();
  status_.recording_error.clear();
  rows_.origin = simulation_->state().step;
  history_.keep(*simulation_);  // a divergence does not lead back to before the recording
  wall_since_row_ = 0;
  steps_since_row_ = 0;
  const auto error = recording_.begin(start.folder, *simulation_);
  status_.recording_folder = start.folder;
  note_record(error);
}

void SimulationWorker::handle(const command::ShowContact& show) {
  contact_ = show.choice;
  publish_frame();
}

/// Steps that are due, for a few milliseconds at most; then a frame, if the last one is old enough.
void SimulationWorker::play_for_a_moment() {
  const Clock::time_point start = Clock::now();
  Clock::time_point now = start;
  do {
    const std::int64_t due = steps_due(now), begin = simulation_->state().step;
    if (due == 0 || !advance(due)) break;
    now = Clock::now();
    meter_.count(simulation_->state().step - begin, simulation_->time(), now);
  } while (now - start < batch_time && !thread_.get_stop_token().stop_requested());
  if (now - last_frame_ >= frame_interval) publish_frame();
}

/// Those between which nothing is looked at: to the next row at most, and one by one where the log is played
/// again. 0: none is due.
std::int64_t SimulationWorker::steps_due(Clock::time_point now) {
  const double time = simulation_->time(), step = simulation_->time_step();
  if (!pace_.is_due(time + step, now)) return 0;
  const std::int64_t most =
      playing_again_ ? 1 : std::min(batch_.steps(), rows_.until_due(simulation_->state().step));
  std::int64_t steps = 1;
  while (steps < most && pace_.due_time(time + static_cast<double>(steps + 1) * step) <= now) ++steps;
  return steps;
}

bool SimulationWorker::advance(std::int64_t steps) {
  if (playing_again_) return advance_again();
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
  rows_.follow(*simulation_);
  if (rows_.due(simulation_->state().step)) take_sample();
  return true;
}

void SimulationWorker::take_sample() {
  const cloth::Measurement m = simulation_->measure();
  history_.keep(*simulation_);
  ChartSample sample{.time_s = m.time,
                     .kinetic_J = m.energy.kinetic,
                     .elastic_J = m.energy.elastic,
                     .gravity_J = m.energy.gravity,
                     .total_J = m.energy.total(),
                     .max_strain = m.strain.maximum()};
  if (steps_since_row_ > 0) sample.step_ms = 1e3 * wall_since_row_ / static_cast<double>(steps_since_row_);
  if (recording_.is_active())
    note_record(recording_.add_row(*simulation_, m, wall_since_row_, steps_since_row_));
  wall_since_row_ = 0;
  steps_since_row_ = 0;

  if (m.step <= last_sampled_step_) return;  // on the way through the history
  last_sampled_step_ = m.step;
  energy_.add(m);
  if (m.step == 0) {
    first_sample_ = sample;
    return;
  }
  if (first_sample_) deliver(*first_sample_);
  first_sample_.reset();
  deliver(sample);
}

/// The view keeps the last good state, and so does the simulation: after an edit it can go on from there.
void SimulationWorker::diverge(const cloth::Divergence& divergence) {
  status_.divergence = divergence;
  ++status_.divergences;
  status_.playing = false;
  playing_again_ = false;
  history_.return_from(divergence, *simulation_);
  drop_later_samples();
  end_recording();
  rows_.follow(*simulation_);
  rows_.origin = simulation_->state().step;
  ++status_.jumps;
  publish_frame();
}

void SimulationWorker::end_recording() {
  if (recording_.is_active())
    note_end(recording_.end(*simulation_, simulation_->state(), status_.divergence));
}

void SimulationWorker::publish_frame() {
  if (!simulation_) return;
  const auto frame = frames_.blank();
  frame->topology = topology_;
  fill_frame(*simulation_, normals_, *frame);
  contact_filler_.fill(*simulation_, contact_, *frame);
  frames_.publish(frame);
  last_frame_ = Clock::now();
}

void SimulationWorker::publish_status() {
  if (simulation_) {
    status_.time = simulation_->time();
    status_.step = simulation_->state().step;
    status_.time_step = simulation_->time_step();
    const auto& unreachable = simulation_->unreachable_rate();
    status_.notice.clear();
    for (const std::string& notice : cloth::scene_notices(simulation_->scene()))
      status_.notice += notice + '\n';
    if (unreachable) status_.notice += cloth::describe(*unreachable, simulation_->system()) + '\n';
    if (auto breach = simulation_->rate_breach()) {
      breach->steps = 1;  // a notice that does not change with every step
      status_.notice += cloth::describe(*breach) + '\n';
    }
    status_.notice += energy_.notice();
    if (status_.notice.ends_with('\n')) status_.notice.pop_back();
    if (!status_.comparison || status_.comparison->scene != simulation_->scene())
      status_.comparison =
          std::make_shared<const cloth::Comparison>(cloth::comparison_of_one(simulation_->scene()));
    status_.history = {.last_step = history_.last_step(),
                       .last_time = history_.last_time(),
                       .states = history_.state_count(),
                       .bytes = history_.bytes(),
                       .max_bytes = history_.max_bytes(),
                       .marks = marks_.of(history_, simulation_->scene())};
  }
  status_.playing_again = status_.playing && playing_again_;
  status_.steps_per_second = status_.playing ? meter_.steps_per_second() : 0;
  status_.real_time_factor = status_.playing ? meter_.real_time_factor() : 0;
  status_.recording = recording_.is_active();
  status_.recorded_rows = recording_.rows();
  publish();
}

}  // namespace clothlab
