#include "bridge/live_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/scene_json.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;
constexpr auto flush_interval = std::chrono::milliseconds(500);

json vector_json(const cloth::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

std::string brush_json(const std::optional<cloth::BrushGust>& brush) {
  if (!brush) return "null";
  json matrix = json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix.push_back(brush->world_to_screen(row, column));
  return json{{"velocity_m_s", vector_json(brush->velocity)},
              {"cursor_px", {brush->cursor.x(), brush->cursor.y()}},
              {"radius_px", brush->radius},
              {"world_to_screen", matrix}}
      .dump();
}

std::string pull_json(const std::optional<cloth::Pull>& pull) {
  if (!pull) return "null";
  return json{{"particle", pull->particle}, {"target_m", vector_json(pull->target)}}.dump();
}

std::optional<cloth::IoError> LiveRecording::open_record(const cloth::Quantities& quantities) {
  quantities_ = quantities;
  ++part_;
  const std::string name = part_ == 1 ? "record.csv" : fmt::format("record-{}.csv", part_);
  return record_.open(folder_ / name, cloth::record_columns(quantities));
}

std::optional<cloth::IoError> LiveRecording::begin(const std::filesystem::path& folder,
                                                   const cloth::Simulation& simulation) {
  folder_ = folder;
  part_ = 0;
  rows_ = 0;
  wall_ = max_strain_ = limiter_excess_ = energy_error_ = 0;
  first_step_ = simulation.state().step;
  first_count_ = simulation.count();
  first_time_ = simulation.time();
  last_flush_ = std::chrono::steady_clock::now();

  cloth::Scene scene = simulation.scene();
  scene.integrator.time_step = simulation.time_step();
  if (auto error = cloth::make_folder(folder)) return error;
  if (auto error = cloth::write_text_file(folder / "scene.json", cloth::write_scene(scene))) return error;
  if (first_step_ > 0)
    if (auto error = cloth::write_text_file(folder / "start_state.csv", cloth::state_csv(simulation.state())))
      return error;
  if (auto error = edits_.open(folder / "edits.jsonl")) return error;
  if (auto error = open_record(simulation.quantities())) return error;
  active_ = true;
  return add_row(simulation, simulation.measure(), 0, 0);
}

std::optional<cloth::IoError> LiveRecording::add_row(const cloth::Simulation& simulation,
                                                     const cloth::Measurement& measurement, double wall,
                                                     std::int64_t steps) {
  if (simulation.quantities() != quantities_)
    if (auto error = open_record(simulation.quantities())) return error;
  ++rows_;
  wall_ += wall;
  max_strain_ = std::max(max_strain_, measurement.strain.maximum());
  limiter_excess_ = std::max(limiter_excess_, measurement.limiter_excess);
  energy_error_ = measurement.energy_error();
  return record_.add(
      cloth::record_row(measurement, quantities_, steps > 0 ? wall / static_cast<double>(steps) : 0));
}

std::optional<cloth::IoError> LiveRecording::log(const EditLogEntry& entry) {
  return edits_.add(fmt::format("{{\"step\":{},\"time_s\":{},\"path\":{},\"value\":{}}}", entry.step,
                                entry.time, json(entry.path).dump(), entry.value));
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
  summary.energy_drift = energy_error_;
  summary.divergence = divergence;
  summary.status = divergence ? cloth::Status::diverged : cloth::Status::stopped;

  std::optional<cloth::IoError> first = record_.close();
  const auto keep = [&](std::optional<cloth::IoError> error) {
    if (error && !first) first = std::move(error);
  };
  keep(edits_.close());
  keep(cloth::write_text_file(folder_ / "final_state.csv", cloth::state_csv(last_good)));
  keep(cloth::write_text_file(folder_ / "summary.json", cloth::summary_json(summary)));
  return first;
}

}  // namespace clothlab
