#include "bridge/live_recording.h"

#include <algorithm>

#include "bridge/worker_pace.h"
#include "scene/scene_mesh.h"
#include "simulation/session_json.h"

namespace clothlab {
std::optional<cloth::IoError> LiveRecording::begin(const std::filesystem::path& folder,
                                                   const cloth::Simulation& simulation) {
  rows_ = 0;
  wall_ = max_strain_ = limiter_excess_ = 0;
  energy_ = {};
  first_step_ = simulation.state().step;
  first_count_ = simulation.count();
  first_time_ = simulation.time();
  last_flush_ = std::chrono::steady_clock::now();

  cloth::Scene scene = simulation.scene();
  scene.integrator.time_step = simulation.time_step();
  cloth::FolderUse use{
      .kind = "run", .files = {"scene.json", "record.csv", "final_state.csv", "edits.jsonl", "summary.json"}};
  for (const std::string& mesh : cloth::mesh_files(scene)) use.inputs.emplace_back(mesh);
  if (auto error = folder_.claim(folder, use)) return error;
  const cloth::Scene moved = moved_to_folder(scene, folder.string());
  if (auto error = folder_.write("scene.json", cloth::write_scene(moved))) return error;
  if (first_step_ > 0)
    if (auto error = folder_.write("start_state.csv", cloth::state_csv(simulation.state()), true))
      return error;
  if (auto error = folder_.add("edits.jsonl")) return error;
  if (auto error = edits_.open(folder_ / "edits.jsonl")) return error;
  if (auto error = record_.open(folder_, simulation.quantities())) return error;
  active_ = true;
  return add_row(simulation, simulation.measure(), 0, 0);
}

std::optional<cloth::IoError> LiveRecording::add_row(const cloth::Simulation& simulation,
                                                     const cloth::Measurement& measurement, double wall,
                                                     std::int64_t steps) {
  ++rows_;
  wall_ += wall;
  max_strain_ = std::max(max_strain_, measurement.strain.maximum());
  limiter_excess_ = std::max(limiter_excess_, measurement.limiter_excess);
  energy_.add(measurement);
  return record_.add(measurement, simulation.quantities(), steps > 0 ? wall / static_cast<double>(steps) : 0);
}

std::optional<cloth::IoError> LiveRecording::log(const cloth::SessionCommand& command) {
  for (const std::string& line : cloth::edit_log_lines(command))
    if (auto error = edits_.add(line)) return error;
  return std::nullopt;
}

std::optional<cloth::IoError> LiveRecording::keep_current(bool now) {
  const auto time = std::chrono::steady_clock::now();
  if (!now && time - last_flush_ < flush_interval) return std::nullopt;
  last_flush_ = time;
  if (auto error = record_.flush()) return error;
  return edits_.flush();
}

std::optional<cloth::IoError> LiveRecording::end(const cloth::Simulation& simulation,
                                                 const cloth::ClothState& last_good,
                                                 const std::optional<cloth::Divergence>& divergence) {
  active_ = false;
  cloth::RunSummary summary;
  summary.wall = wall_;
  summary.scene_hash = cloth::scene_hash(simulation.scene());
  summary.title = simulation.scene().title;
  summary.method = simulation.scene().integrator.method;
  summary.time_step = simulation.time_step();
  summary.particles = simulation.system().size();
  summary.simulated = last_good.time - first_time_;
  summary.count = simulation.count().since(first_count_);
  summary.count.steps = last_good.step - first_step_;  // without one that diverged
  summary.max_strain = max_strain_;
  summary.limiter_excess = limiter_excess_;
  summary.energy = energy_;
  const auto note = [&](const std::string& sentence) {
    if (!sentence.empty()) summary.notice += (summary.notice.empty() ? "" : "; ") + sentence;
  };
  note(describe(summary.count));
  if (!divergence) note(describe(energy_));
  summary.rate_breach = simulation.rate_breach();
  if (summary.rate_breach) note(describe(*summary.rate_breach));
  summary.divergence = divergence;
  summary.step_changes = simulation.step_changes();
  summary.status = divergence ? cloth::Status::diverged : cloth::Status::stopped;

  std::optional<cloth::IoError> first = record_.close();
  const auto keep = [&](std::optional<cloth::IoError> error) {
    if (error && !first) first = std::move(error);
    return !first;
  };
  if (keep(edits_.close())) {
    cloth::FileDigest edits = edits_.digest();
    edits.rows.reset();
    folder_.note(edits);
  }
  if (!first && keep(folder_.write("final_state.csv", cloth::state_csv(last_good), true))) {
    summary.files = folder_.digests();
    keep(folder_.finish("summary.json", cloth::summary_json(summary)));
  }
  folder_.release();
  return first;
}

}  // namespace clothlab
