#include "simulation/recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cloth/grid.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_json.h"
#include "support/files.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::recorder_test {
namespace {

TEST(RecordColumns, StandInTheOrderOfTheContract) {
  Quantities all{.damping = true,
                 .air = true,
                 .brush = true,
                 .pull = true,
                 .limiter = true,
                 .contact = true,
                 .structural = true,
                 .shear = true,
                 .continuous_contact = true};
  std::vector<std::string> expected{"time_s",
                                    "step",
                                    "kinetic_J",
                                    "elastic_J",
                                    "gravity_J",
                                    "total_J",
                                    "damping_loss_J",
                                    "air_work_J",
                                    "brush_work_J",
                                    "pull_work_J",
                                    "limiter_work_J",
                                    "contact_work_J",
                                    "energy_error_J",
                                    "max_strain",
                                    "max_strain_structural",
                                    "max_strain_shear",
                                    "limiter_sweeps",
                                    "limiter_excess",
                                    "contacts",
                                    "held_back",
                                    "contact_impulse_x_Ns",
                                    "contact_impulse_y_Ns",
                                    "contact_impulse_z_Ns",
                                    "step_time_us"};
  EXPECT_EQ(record_columns(all), expected);
}

TEST(RecordColumns, OfAStageThatIsLeftOutAreNotThere) {
  EXPECT_EQ(record_columns(Quantities{}),
            std::vector<std::string>({"time_s", "step", "kinetic_J", "elastic_J", "gravity_J", "total_J",
                                      "energy_error_J", "max_strain", "step_time_us"}));
}

TEST(RecordColumns, FollowTheScenesStages) {
  const auto has = [](const Scene& scene, const std::string& name) {
    const auto names = record_columns(Simulation(scene).quantities());
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const Scene ball = builtin_scene("ball"), fall = builtin_scene("free-fall");
  for (const char* name : {"contact_work_J", "contacts", "limiter_work_J", "limiter_sweeps", "air_work_J"}) {
    EXPECT_TRUE(has(ball, name)) << name;
    EXPECT_FALSE(has(fall, name)) << name;
  }
  for (const char* name : {"held_back", "contact_impulse_x_Ns", "contact_impulse_z_Ns"}) {
    EXPECT_TRUE(has(builtin_scene("slope"), name)) << name;
    EXPECT_FALSE(has(ball, name)) << name << ": contact particle by particle does not say it";
    EXPECT_FALSE(has(fall, name)) << name;
  }
  Scene bare = bare_sheet(3, 3);
  bare.deformation.emplace();  // limits springs that do not exist
  bare.air = Air{.drag = 0, .wind = {1, 0, 0}, .gust = std::nullopt};
  for (const char* name : {"damping_loss_J", "air_work_J", "limiter_work_J", "max_strain_structural"})
    EXPECT_FALSE(has(bare, name)) << name;
}

Scene short_pendulum() {
  Scene scene = builtin_scene("pendulum");
  scene.duration = 0.25;
  return scene;
}

TEST(Record, HasARowForEveryIntervalAndReadsBack) {
  const TemporaryFolder folder;
  const Scene scene = short_pendulum();
  const RunResult result = run_scene(scene, {.folder = folder.path(), .progress = {}});
  EXPECT_EQ(result.summary.status, Status::finished);
  const CsvTable table = parse_csv(content_of(folder / "record.csv"));
  ASSERT_EQ(table.rows.size(), 26u);
  const auto times = column_of(table, "time_s"), steps = column_of(table, "step");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.rows[row].size(), table.header.size());
    EXPECT_NEAR(times[row], 0.01 * static_cast<double>(row), 1e-12);
    EXPECT_EQ(times[row], steps[row] * result.summary.time_step);  // n h, never added up
  }
}

TEST(Record, SaysWhatWasMeasuredToTheBit) {
  const TemporaryFolder folder;
  const Scene scene = short_pendulum();
  run_scene(scene, {.folder = folder.path(), .progress = {}});
  const CsvTable table = parse_csv(content_of(folder / "record.csv"));
  Simulation simulation(scene);
  while (simulation.time() < column_of(table, "time_s").back()) simulation.step();
  const Measurement m = simulation.measure();
  EXPECT_EQ(column_of(table, "kinetic_J").back(), m.energy.kinetic);
  EXPECT_EQ(column_of(table, "elastic_J").back(), m.energy.elastic);
  EXPECT_EQ(column_of(table, "gravity_J").back(), m.energy.gravity);
  EXPECT_EQ(column_of(table, "total_J").back(), m.energy.total());
  EXPECT_EQ(column_of(table, "damping_loss_J").back(), m.ledger.forces.damping_loss);
  EXPECT_EQ(column_of(table, "energy_error_J").back(), m.energy_error());
  EXPECT_EQ(column_of(table, "max_strain").back(), m.strain.maximum());
}

TEST(Record, OfAContactThatHoldsTheClothHasItsWeightTimesTheTime) {
  const TemporaryFolder folder;
  Scene scene = builtin_scene("slope");
  scene.duration = 0.5;
  run_scene(scene, {.folder = folder.path(), .progress = {}});
  const CsvTable table = parse_csv(content_of(folder / "record.csv"));
  const std::vector<double> times = column_of(table, "time_s"), up = column_of(table, "contact_impulse_y_Ns");
  EXPECT_EQ(up.front(), 0);
  const double force = (up.back() - up[10]) / (times.back() - times[10]);
  EXPECT_NEAR(force, scene.cloth.mass * 9.81, 1e-6 * force);
  EXPECT_NEAR(column_of(table, "contact_impulse_x_Ns").back(), 0, 1e-4 * up.back());
  EXPECT_GT(column_of(table, "contacts").back(), 0);
}

TEST(RunFolder, HoldsTheSceneAsRunWithItsDefaultsResolved) {
  const TemporaryFolder folder;
  const RunResult result = run_scene(short_pendulum(), {.folder = folder.path(), .progress = {}});
  const SceneReading reading = read_scene(content_of(folder / "scene.json"), "scene.json");
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(reading.scene->integrator.time_step, result.summary.time_step);
  Scene expected = short_pendulum();
  expected.integrator.time_step = result.summary.time_step;
  EXPECT_EQ(*reading.scene, expected);
}

TEST(RunFolder, HoldsTheFinalStateToTheBit) {
  const TemporaryFolder folder;
  const RunResult result = run_scene(short_pendulum(), {.folder = folder.path(), .progress = {}});
  const CsvTable table = parse_csv(content_of(folder / "final_state.csv"));
  EXPECT_EQ(table.header,
            std::vector<std::string>({"particle", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"}));
  ASSERT_EQ(table.rows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(column_of(table, "particle")[i], static_cast<double>(i));
    EXPECT_EQ(column_of(table, "x_m")[i], result.final_state.position[i].x());
    EXPECT_EQ(column_of(table, "y_m")[i], result.final_state.position[i].y());
    EXPECT_EQ(column_of(table, "vz_m_s")[i], result.final_state.velocity[i].z());
  }
}

TEST(RunFolder, SaysWhatTheEquationsOfAMethodTook) {
  const auto solver_of = [](const char* method) {
    const TemporaryFolder folder;
    Scene scene = short_pendulum();
    scene.integrator.method = method;
    scene.integrator.tolerance = 1e-12;
    run_scene(scene, {.folder = folder.path(), .progress = {}});
    return nlohmann::json::parse(content_of(folder / "summary.json"))["solver"];
  };
  EXPECT_TRUE(solver_of("rk4").is_null());
  EXPECT_GT(solver_of("dormand-prince")["inner_steps"], 0);
  const auto newton = solver_of("implicit-euler");
  EXPECT_GT(newton["iterations"], 0);
  EXPECT_TRUE(newton.contains("largest_residual"));
  EXPECT_FALSE(newton.contains("limiter_sweeps"));
}

TEST(RunFolder, HoldsASummaryOfTheRun) {
  const TemporaryFolder folder;
  const Scene scene = short_pendulum();
  const RunResult result = run_scene(scene, {.folder = folder.path(), .progress = {}});
  const auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_EQ(summary["method"], "rk4");
  EXPECT_EQ(summary["steps"], result.summary.count.steps);
  EXPECT_EQ(summary["force_evaluations"], 4 * result.summary.count.steps);
  EXPECT_EQ(summary["scene_hash"], scene_hash(scene));
  EXPECT_EQ(summary["particles"], 4);
  EXPECT_NEAR(summary["simulated_s"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(summary["threads"], 1);
  for (const char* key :
       {"version", "host", "wall_s", "ns_per_particle_step", "max_strain", "energy_drift_J"})
    EXPECT_TRUE(summary.contains(key)) << key;
}

/// Hung by two corners, stiff, at three times the stable step.
Scene diverging_scene(const std::string& method) {
  Scene scene = bare_sheet(6, 6);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 1000, .shear = 500, .flexion = 100, .damping = 0};
  scene.damping = 0.01;
  scene.gravity = Vec3(0.1, -9.81, 0.2);
  scene.integrator = {method, 3 * stable_step(method, scene).value()};
  scene.record.interval = 5 * *scene.integrator.time_step;
  scene.duration = 10;
  return scene;
}

TEST(ADivergingRun, StopsAndNamesStepTimeParticleAndTheStableStep) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    const Scene scene = diverging_scene(method);
    const RunResult result = run_scene(scene, {.folder = {}, .progress = {}});
    ASSERT_EQ(result.summary.status, Status::diverged) << method;
    ASSERT_TRUE(result.summary.divergence);
    const Divergence& d = *result.summary.divergence;
    EXPECT_EQ(d.step, result.summary.count.steps);
    EXPECT_DOUBLE_EQ(d.time, static_cast<double>(d.step) * *scene.integrator.time_step);
    EXPECT_EQ(d.particle, d.row * 6 + d.column);
    EXPECT_NE(d.particle, 0);
    EXPECT_EQ(d.stable_step, guaranteed_step(method, scene).value());
    const std::string text = describe(d);
    for (const std::string& word :
         {"step " + std::to_string(d.step), "particle " + std::to_string(d.particle)})
      EXPECT_NE(text.find(word), std::string::npos) << text;
    EXPECT_LT(d.time, scene.duration / 2);
  }
}

TEST(ADivergingRun, LeavesAFiniteRecordWhoseLastRowIsTheFinalState) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    const TemporaryFolder folder;
    const Scene scene = diverging_scene(method);
    const RunResult result = run_scene(scene, {.folder = folder.path(), .progress = {}});
    ASSERT_EQ(result.summary.status, Status::diverged);
    EXPECT_TRUE(all_finite(result.final_state));
    const CsvTable table = parse_csv(content_of(folder / "record.csv"));
    for (const std::string& name : table.header)
      for (const double value : column_of(table, name)) EXPECT_TRUE(std::isfinite(value)) << name;
    EXPECT_EQ(column_of(table, "time_s").back(), result.final_state.time);
    const ClothSystem system = make_grid(scene.cloth, *scene.springs);
    EXPECT_EQ(column_of(table, "kinetic_J").back(), kinetic_energy(system, result.final_state.velocity));
    const auto summary = nlohmann::json::parse(content_of(folder / "summary.json"));
    EXPECT_EQ(summary["status"], "diverged");
    for (const char* key : {"step", "time_s", "particle", "stable_step_s", "message"})
      EXPECT_TRUE(summary["diverged"].contains(key)) << key;
    EXPECT_EQ(parse_csv(content_of(folder / "final_state.csv")).rows.size(), 36u);
  }
}

TEST(ARun, IsStoppedByItsProgressAndLeavesWhatItHas) {
  const TemporaryFolder folder;
  Scene scene = builtin_scene("corners-free");
  scene.duration = 1000;
  const RunResult result =
      run_scene(scene, {.folder = folder.path(), .progress = [](double) { return false; }});
  EXPECT_EQ(result.summary.status, Status::stopped);
  EXPECT_GE(parse_csv(content_of(folder / "record.csv")).rows.size(), 1u);
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "summary.json"))["status"], "stopped");
}

TEST(ARun, IntoAFolderThatCannotBeSaysSo) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "file", "x"));
  const RunResult result = run_scene(short_pendulum(), {.folder = folder / "file", .progress = {}});
  ASSERT_TRUE(result.io_error);
  EXPECT_EQ(result.io_error->path, folder / "file");
}

TEST(ARunWithoutAFolder, LeavesNothingAndEndsInTheSameState) {
  const TemporaryFolder folder;
  const RunResult with = run_scene(short_pendulum(), {.folder = folder.path(), .progress = {}});
  const RunResult without = run_scene(short_pendulum(), {.folder = {}, .progress = {}});
  EXPECT_EQ(with.final_state, without.final_state);
}

}  // namespace
}  // namespace cloth::test::recorder_test
