#include "simulation/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "measure/oblique_locking.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "scene/scene_mesh.h"
#include "simulation/session.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// So that whoever wants to stop a run need not wait.
constexpr std::int64_t max_steps_of_batch = 32, steps_between_looks = 16;
constexpr double look_interval = 0.1;  ///< s

struct Column {
  const char* name;
  bool (*present)(const Quantities&);
  double (*value)(const Measurement&);
  bool is_count = false;  ///< a whole number

  std::string text(const Measurement& m) const {
    return is_count ? std::to_string(static_cast<std::int64_t>(value(m))) : csv_number(value(m));
  }
};

constexpr auto always = [](const Quantities&) { return true; };

/// Every column that record.csv can have beside those of probes, once; probes and step_time_us follow them
/// all.
const std::vector<Column>& columns() {
  using M = const Measurement&;
  using Q = const Quantities&;
  static const auto strain_of = [](M m, SpringFamily f) {
    return m.strain.largest[static_cast<std::size_t>(f)];
  };
  static const std::vector<Column> all{
      {"time_s", always, [](M m) { return m.time; }},
      {"step", always, [](M m) { return static_cast<double>(m.step); }, true},
      {"kinetic_J", always, [](M m) { return m.energy.kinetic; }},
      {"elastic_J", always, [](M m) { return m.energy.elastic; }},
      {"bending_J", [](Q q) { return q.bending; }, [](M m) { return m.energy.bending; }},
      {"gravity_J", always, [](M m) { return m.energy.gravity; }},
      {"total_J", always, [](M m) { return m.energy.total(); }},
      {"damping_loss_J", [](Q q) { return q.damping; }, [](M m) { return m.ledger.forces.damping_loss; }},
      {"hysteresis_loss_J", [](Q q) { return q.hysteresis; },
       [](M m) { return m.ledger.forces.hysteresis_loss; }},
      {"air_work_J", [](Q q) { return q.air; }, [](M m) { return m.ledger.forces.air; }},
      {"brush_work_J", [](Q q) { return q.brush; }, [](M m) { return m.ledger.forces.brush; }},
      {"pull_work_J", [](Q q) { return q.pull; }, [](M m) { return m.ledger.forces.pull; }},
      {"limiter_work_J", [](Q q) { return q.limiter; }, [](M m) { return m.ledger.limiter; }},
      {"contact_work_J", [](Q q) { return q.contact; }, [](M m) { return m.ledger.contact; }},
      {"energy_error_J", always, [](M m) { return m.energy_error(); }},
      {"max_strain", always, [](M m) { return m.strain.maximum(); }},
      {"max_strain_structural", [](Q q) { return q.structural; },
       [](M m) { return strain_of(m, SpringFamily::structural); }},
      {"max_strain_shear", [](Q q) { return q.shear; },
       [](M m) { return strain_of(m, SpringFamily::shear); }},
      {"limiter_sweeps", [](Q q) { return q.limiter; },
       [](M m) { return static_cast<double>(m.limiter_sweeps); }, true},
      {"limiter_excess", [](Q q) { return q.limiter; }, [](M m) { return m.limiter_excess; }},
      {"contacts", [](Q q) { return q.contact; }, [](M m) { return static_cast<double>(m.contacts); }, true},
      {"held_back", [](Q q) { return q.continuous_contact; },
       [](M m) { return static_cast<double>(m.held_back); }, true},
      {"contact_impulse_x_Ns", [](Q q) { return q.continuous_contact; },
       [](M m) { return m.contact_impulse.x(); }},
      {"contact_impulse_y_Ns", [](Q q) { return q.continuous_contact; },
       [](M m) { return m.contact_impulse.y(); }},
      {"contact_impulse_z_Ns", [](Q q) { return q.continuous_contact; },
       [](M m) { return m.contact_impulse.z(); }},
  };
  return all;
}

/// What is to be done within a run, and where it ends.
struct Script {
  const std::vector<SessionCommand>* commands = nullptr;
  std::int64_t steps = 0;
  double until = std::numeric_limits<double>::infinity();  ///< s
};

/// A run in progress: the simulation, its file, and the last state that was good.
class Run {
 public:
  Run(const Scene& scene, const RunOptions& options, const Script& script = {})
      : scene_(scene),
        options_(options),
        script_(script),
        simulation_(scene),
        clock_(RowClock::of(simulation_)) {
    find_end();
    RunSummary& summary = result_.summary;
    summary.scene_hash = scene_hash(scene);
    summary.title = scene.title;
    summary.method = scene.integrator.method;
    summary.time_step = simulation_.time_step();
    summary.particles = simulation_.system().size();
    simulation_.set_threads(options_.threads);
    if (options_.progress) simulation_.set_stop_test([this] { return !may_finish_step(); });
    summary.threads = simulation_.threads();
    summary.notice = fmt::format("{}", fmt::join(scene_notices(scene), "; "));
    if (!script_.commands) {
      note(uneven_duration_text(scene.duration, simulation_.time_step()));
      note(too_long_step_text(scene));
    }
    if (simulation_.unreachable_rate()) note(describe(*simulation_.unreachable_rate(), simulation_.system()));
  }

  RunResult to_end() {
    if (!options_.folder.empty() && !begin_folder()) return std::move(result_);
    note_end();
    bool going = add_row() && carry_out_due();
    while (going && !ended_ && may_go_on()) {
      const std::int64_t begin = simulation_.state().step, count = steps_until_seen();
      const Clock::time_point start = Clock::now();
      result_.summary.divergence = simulation_.advance(count);
      const double taken = seconds_since(start);
      wall_since_row_ += taken;
      result_.summary.wall += taken;
      if (result_.summary.divergence || simulation_.interrupted()) break;
      steps_since_row_ += simulation_.state().step - begin;
      clock_.follow(simulation_);
      find_end();
      note_end();
      if (clock_.due(simulation_.state().step) || ended_) going = add_row();
      going = going && carry_out_due();
    }
    finish();
    return std::move(result_);
  }

  const std::vector<Problem>& problems() const { return problems_; }
  std::size_t carried_out() const { return next_; }  ///< commands

 private:
  void note(const std::string& sentence) {
    std::string& notice = result_.summary.notice;
    if (!sentence.empty()) notice += (notice.empty() ? "" : "; ") + sentence;
  }

  bool keep(std::optional<IoError> error) {
    if (error && !result_.io_error) result_.io_error = std::move(error);
    return !result_.io_error;
  }

  std::optional<IoError> write_scene_file(const Scene& scene) {
    return folder_.write("scene.json", write_scene(moved_to_folder(scene, options_.folder.string())));
  }

  bool begin_folder() {
    FolderUse use{.kind = "run", .files = run_files(), .inputs = options_.inputs};
    for (const auto& mesh : mesh_files(scene_)) use.inputs.push_back(mesh);
    Scene resolved = scene_;
    resolved.integrator.time_step = simulation_.time_step();
    return keep(folder_.claim(options_.folder, use)) && keep(write_scene_file(resolved)) &&
           keep(record_.open(folder_, simulation_.quantities()));
  }

  /// Steps to the next of which somebody sees the state: a row, a command, the end.
  std::int64_t steps_until_seen() const {
    if (script_.commands) return 1;
    const std::int64_t step = simulation_.state().step;
    return std::min({max_steps_of_batch, clock_.until_due(step), script_.steps - step});
  }

  /// A scene runs to its duration, a session for its steps.
  void find_end() {
    if (script_.commands) return;
    script_.steps = simulation_.first_step() +
                    steps_to_cover(scene_.duration - simulation_.first_time(), simulation_.time_step());
  }

  void note_end() {
    ended_ = simulation_.state().step >= script_.steps ||
             simulation_.time() + 0.5 * simulation_.time_step() > script_.until;
  }

  /// What the script has for the present step. A row shows the state before it.
  bool carry_out_due() {
    if (!script_.commands) return true;
    const auto& commands = *script_.commands;
    for (; next_ < commands.size() && commands[next_].step == simulation_.state().step; ++next_) {
      problems_ = carry_out(commands[next_].action, simulation_);
      if (!problems_.empty()) return false;
    }
    clock_.follow(simulation_);
    return true;
  }

  bool add_row() {
    const Measurement measurement = simulation_.measure();
    result_.final_state = simulation_.state();
    RunSummary& summary = result_.summary;
    summary.max_strain = std::max(summary.max_strain, measurement.strain.maximum());
    summary.limiter_excess = std::max(summary.limiter_excess, measurement.limiter_excess);
    summary.energy.add(measurement);
    const double mean = steps_since_row_ > 0 ? wall_since_row_ / static_cast<double>(steps_since_row_) : 0;
    steps_since_row_ = 0;
    wall_since_row_ = 0;
    if (options_.row) options_.row(simulation_, measurement);
    return !record_.is_open() || keep(record_.add(measurement, simulation_.quantities(), mean));
  }

  /// Asked within steps that take long.
  bool may_finish_step() {
    if (seconds_since(last_look_) < look_interval) return true;
    last_look_ = Clock::now();
    return options_.progress(simulation_.time());
  }

  bool may_go_on() {
    if (!options_.progress || simulation_.state().step < next_look_ ||
        seconds_since(last_look_) < look_interval)
      return true;
    next_look_ = simulation_.state().step + steps_between_looks;
    last_look_ = Clock::now();
    keep(record_.flush());
    return options_.progress(simulation_.time()) && !result_.io_error;
  }

  void finish() {
    RunSummary& summary = result_.summary;
    if (ended_ && !summary.divergence) result_.final_state = simulation_.state();  // after the last commands
    summary.count = simulation_.count();
    summary.step_changes = simulation_.step_changes();
    summary.simulated = result_.final_state.time;
    summary.status = summary.divergence              ? Status::diverged
                     : !ended_ || !problems_.empty() ? Status::stopped
                                                     : Status::finished;
    note(describe(summary.count));
    if (!summary.divergence) note(describe(summary.energy));
    if (!summary.divergence)
      note(locking_text(scene_,
                        measure_oblique_locking(scene_, simulation_.system(), result_.final_state.position)));
    summary.rate_breach = simulation_.rate_breach();
    if (summary.rate_breach) note(describe(*summary.rate_breach));
    if (!folder_.is_open()) return;
    keep(record_.close());
    if (!summary.step_changes.empty()) keep(write_scene_file(scene_));  // no one step repeats this run
    // Without its record a run has no summary: what has one is whole.
    if (result_.io_error || !keep(folder_.write("final_state.csv", state_csv(result_.final_state), true)))
      return;
    summary.files = folder_.digests();
    keep(folder_.finish("summary.json", summary_json(summary)));
  }

  const Scene& scene_;
  const RunOptions& options_;
  Script script_;
  Simulation simulation_;
  RowClock clock_;
  ResultFolder folder_;
  RecordFile record_;
  RunResult result_;
  bool ended_ = false;
  std::size_t next_ = 0;  ///< of the script's commands
  std::vector<Problem> problems_;
  std::int64_t steps_since_row_ = 0;
  double wall_since_row_ = 0;
  std::int64_t next_look_ = 0;  ///< step
  Clock::time_point last_look_ = Clock::now();
};

}  // namespace

std::vector<std::string> record_columns(const Quantities& quantities) {
  std::vector<std::string> names;
  for (const Column& column : columns())
    if (column.present(quantities)) names.emplace_back(column.name);
  names.insert(names.end(), quantities.probes.begin(), quantities.probes.end());
  names.emplace_back("step_time_us");
  return names;
}

std::optional<double> recorded_value(const std::string& column, const Measurement& measurement,
                                     const Quantities& quantities) {
  for (const Column& known : columns())
    if (known.name == column && known.present(quantities)) return known.value(measurement);
  const auto probe = std::find(quantities.probes.begin(), quantities.probes.end(), column);
  if (probe != quantities.probes.end())
    return measurement.probes[static_cast<std::size_t>(probe - quantities.probes.begin())];
  return std::nullopt;
}

std::vector<std::string> record_row(const Measurement& measurement, const Quantities& quantities,
                                    double step_time) {
  std::vector<std::string> row;
  for (const Column& column : columns())
    if (column.present(quantities)) row.push_back(column.text(measurement));
  for (const double value : measurement.probes) row.push_back(std::isnan(value) ? "" : csv_number(value));
  row.push_back(csv_number(1e6 * step_time));
  return row;
}

RowClock RowClock::of(const Simulation& simulation) {
  return {.origin = simulation.state().step,
          .stride = simulation.steps_to_row(),
          .first_step = simulation.first_step(),
          .within_interval = false};
}

void RowClock::follow(const Simulation& simulation) {
  RowClock now = of(simulation);
  if (now.stride == stride && now.first_step == first_step) return;
  now.origin = now.first_step;
  now.within_interval = simulation.is_within_interval();
  *this = now;
}

std::optional<IoError> RecordFile::open(ResultFolder& folder, const Quantities& quantities) {
  folder_ = &folder;
  part_ = 0;
  return open_part(quantities);
}

std::optional<IoError> RecordFile::open_part(const Quantities& quantities) {
  quantities_ = quantities;
  const std::string name = ++part_ == 1 ? "record.csv" : fmt::format("record-{}.csv", part_);
  if (auto error = folder_->add(name)) return error;
  return csv_.open(*folder_ / name, record_columns(quantities));
}

std::optional<IoError> RecordFile::close() {
  if (!csv_.is_open()) return std::nullopt;
  if (auto error = csv_.close()) return error;
  folder_->note(csv_.digest());
  return std::nullopt;
}

std::optional<IoError> RecordFile::add(const Measurement& measurement, const Quantities& quantities,
                                       double step_time) {
  if (quantities != quantities_) {
    if (auto error = close()) return error;
    if (auto error = open_part(quantities)) return error;
  }
  return csv_.add(record_row(measurement, quantities, step_time));
}

const std::vector<std::string>& run_files() {
  static const std::vector<std::string> names{"scene.json", "record.csv", "final_state.csv", "summary.json"};
  return names;
}

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  return Run(scene, options).to_end();
}

ReplayResult replay(const Session& session, const ReplayOptions& options) {
  const RunOptions run_options{
      .folder = options.folder, .progress = options.progress, .inputs = options.inputs};
  Run run(session.scene, run_options,
          {.commands = &session.commands, .steps = session.steps, .until = options.until});
  ReplayResult result;
  result.run = run.to_end();
  result.commands = run.carried_out();
  result.problems = run.problems();
  const bool at_end = result.run.summary.status == Status::finished &&
                      result.run.final_state.step == session.steps && !result.run.io_error;
  if (at_end && !session.final_state_hash.empty())
    result.agrees = state_hash(result.run.final_state) == session.final_state_hash;
  return result;
}

std::string describe(const UnreachableRate& u, const ClothSystem& system) {
  const auto pin = [&](int particle) {
    if (system.is_mesh()) return fmt::format("{}", particle);
    return fmt::format("(row {}, column {})", particle / system.columns, particle % system.columns);
  };
  return fmt::format(
      "deformation.rate cannot be kept: pins {} and {} are {:.6g} m apart, and the limited springs between "
      "them reach {:.6g} m at this rate",
      pin(u.first), pin(u.second), u.distance, u.reach);
}

}  // namespace cloth
