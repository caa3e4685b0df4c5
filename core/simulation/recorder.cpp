#include "simulation/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "scene/scene_json.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Column {
  const char* name;
  bool (*present)(const Quantities&);
  std::string (*text)(const Measurement&);
};

constexpr auto always = [](const Quantities&) { return true; };

/// Every column that record.csv can have, once; step_time_us follows them all.
const std::vector<Column>& columns() {
  using M = const Measurement&;
  using Q = const Quantities&;
  const auto family = [](M m, SpringFamily f) {
    return csv_number(m.strain.largest[static_cast<std::size_t>(f)]);
  };
  static const auto strain_of = family;
  static const std::vector<Column> all{
      {"time_s", always, [](M m) { return csv_number(m.time); }},
      {"step", always, [](M m) { return std::to_string(m.step); }},
      {"kinetic_J", always, [](M m) { return csv_number(m.energy.kinetic); }},
      {"elastic_J", always, [](M m) { return csv_number(m.energy.elastic); }},
      {"gravity_J", always, [](M m) { return csv_number(m.energy.gravity); }},
      {"total_J", always, [](M m) { return csv_number(m.energy.total()); }},
      {"damping_loss_J", [](Q q) { return q.damping; },
       [](M m) { return csv_number(m.ledger.forces.damping_loss); }},
      {"air_work_J", [](Q q) { return q.air; }, [](M m) { return csv_number(m.ledger.forces.air); }},
      {"brush_work_J", [](Q q) { return q.brush; }, [](M m) { return csv_number(m.ledger.forces.brush); }},
      {"pull_work_J", [](Q q) { return q.pull; }, [](M m) { return csv_number(m.ledger.forces.pull); }},
      {"limiter_work_J", [](Q q) { return q.limiter; }, [](M m) { return csv_number(m.ledger.limiter); }},
      {"contact_work_J", [](Q q) { return q.contact; }, [](M m) { return csv_number(m.ledger.contact); }},
      {"energy_error_J", always, [](M m) { return csv_number(m.energy_error()); }},
      {"max_strain", always, [](M m) { return csv_number(m.strain.maximum()); }},
      {"max_strain_structural", [](Q q) { return q.structural; },
       [](M m) { return strain_of(m, SpringFamily::structural); }},
      {"max_strain_shear", [](Q q) { return q.shear; },
       [](M m) { return strain_of(m, SpringFamily::shear); }},
      {"limiter_sweeps", [](Q q) { return q.limiter; }, [](M m) { return std::to_string(m.limiter_sweeps); }},
      {"limiter_excess", [](Q q) { return q.limiter; }, [](M m) { return csv_number(m.limiter_excess); }},
      {"contacts", [](Q q) { return q.contact; }, [](M m) { return std::to_string(m.contacts); }},
  };
  return all;
}

/// A run in progress: the simulation, its file, and the last state that was good.
class Run {
 public:
  Run(const Scene& scene, const RunOptions& options)
      : scene_(scene), options_(options), simulation_(scene), clock_(RowClock::of(simulation_)) {
    RunSummary& summary = result_.summary;
    summary.scene_hash = scene_hash(scene);
    summary.title = scene.title;
    summary.method = scene.integrator.method;
    summary.time_step = simulation_.time_step();
    summary.particles = simulation_.system().size();
    simulation_.set_threads(options_.threads);
    summary.threads = simulation_.threads();
    if (simulation_.unreachable_rate())
      summary.notice = describe(*simulation_.unreachable_rate(), simulation_.system().columns);
  }

  RunResult to_end() {
    if (!options_.folder.empty() && !begin_folder()) return std::move(result_);
    const std::int64_t last = steps_to_cover(scene_.duration, simulation_.time_step());
    bool recorded = add_row();
    while (recorded && simulation_.state().step < last && may_go_on()) {
      const Clock::time_point start = Clock::now();
      result_.summary.divergence = simulation_.step();
      const double taken = seconds_since(start);
      wall_since_row_ += taken;
      result_.summary.wall += taken;
      if (result_.summary.divergence) break;
      ++steps_since_row_;
      const std::int64_t step = simulation_.state().step;
      if (clock_.due(step) || step == last) recorded = add_row();
    }
    finish(last);
    return std::move(result_);
  }

 private:
  bool keep(std::optional<IoError> error) {
    if (error && !result_.io_error) result_.io_error = std::move(error);
    return !result_.io_error;
  }

  bool begin_folder() {
    Scene resolved = scene_;
    resolved.integrator.time_step = simulation_.time_step();
    return keep(make_folder(options_.folder)) &&
           keep(write_text_file(options_.folder / "scene.json", write_scene(resolved))) &&
           keep(csv_.open(options_.folder / "record.csv", record_columns(simulation_.quantities())));
  }

  bool add_row() {
    const Measurement measurement = simulation_.measure();
    result_.final_state = simulation_.state();
    RunSummary& summary = result_.summary;
    summary.max_strain = std::max(summary.max_strain, measurement.strain.maximum());
    summary.limiter_excess = std::max(summary.limiter_excess, measurement.limiter_excess);
    summary.energy_drift = measurement.energy_error();
    const double mean = steps_since_row_ > 0 ? wall_since_row_ / static_cast<double>(steps_since_row_) : 0;
    steps_since_row_ = 0;
    wall_since_row_ = 0;
    return !csv_.is_open() || keep(csv_.add(record_row(measurement, simulation_.quantities(), mean)));
  }

  bool may_go_on() {
    constexpr double interval = 0.1;
    constexpr int steps_between_looks = 16;
    if (!options_.progress || ++looks_ % steps_between_looks != 0 || seconds_since(last_look_) < interval)
      return true;
    last_look_ = Clock::now();
    keep(csv_.flush());
    return options_.progress(simulation_.time()) && !result_.io_error;
  }

  void finish(std::int64_t last) {
    RunSummary& summary = result_.summary;
    summary.count = simulation_.count();
    summary.simulated = result_.final_state.time;
    summary.status = summary.divergence                ? Status::diverged
                     : simulation_.state().step < last ? Status::stopped
                                                       : Status::finished;
    if (options_.folder.empty()) return;
    keep(csv_.close());
    keep(write_text_file(options_.folder / "final_state.csv", state_csv(result_.final_state)));
    keep(write_text_file(options_.folder / "summary.json", summary_json(summary)));
  }

  const Scene& scene_;
  const RunOptions& options_;
  Simulation simulation_;
  RowClock clock_;
  CsvFile csv_;
  RunResult result_;
  std::int64_t steps_since_row_ = 0;
  double wall_since_row_ = 0;
  std::int64_t looks_ = 0;
  Clock::time_point last_look_ = Clock::now();
};

}  // namespace

std::vector<std::string> record_columns(const Quantities& quantities) {
  std::vector<std::string> names;
  for (const Column& column : columns())
    if (column.present(quantities)) names.emplace_back(column.name);
  names.emplace_back("step_time_us");
  return names;
}

std::vector<std::string> record_row(const Measurement& measurement, const Quantities& quantities,
                                    double step_time) {
  std::vector<std::string> row;
  for (const Column& column : columns())
    if (column.present(quantities)) row.push_back(column.text(measurement));
  row.push_back(csv_number(1e6 * step_time));
  return row;
}

RowClock RowClock::of(const Simulation& simulation) {
  return {simulation.state().step, steps_per_row(simulation.scene().record.interval, simulation.time_step())};
}

RunResult run_scene(const Scene& scene, const RunOptions& options) {
  return Run(scene, options).to_end();
}

std::string describe(const UnreachableRate& u, int columns) {
  return fmt::format(
      "deformation.rate cannot be kept: pins (row {}, column {}) and (row {}, column {}) are {:.6g} m apart, "
      "and the "
      "limited springs between them reach {:.6g} m at this rate",
      u.first / columns, u.first % columns, u.second / columns, u.second % columns, u.distance, u.reach);
}

}  // namespace cloth
