// The study of iterations: its objective by hand and by differences, and what it finds.
#include "study/iterations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "measure/energy.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_cloth.h"
#include "study/iterations_report.h"
#include "study/step_objective.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::iterations_test {
namespace {

Scene hanging_sheet(int size) {
  Scene scene = bare_sheet(size, size, 0.05, 0.002);
  scene.title = "A hanging sheet";
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 300, .shear = 100, .flexion = 30, .damping = 0};
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

/// A cloth of springs, a grid of a material and a mesh of one: every energy there is.
std::vector<Scene> cloths_of_every_energy(Random& random) {
  Scene mesh = material_mesh_sheet(6, 5, 0.3, 0.2, 0.15, any_material(), random);
  mesh.cloth.pins = {PinnedParticle{0, 0}};
  Scene grid = material_sheet(5, 6, 0.05, 0.04, any_material());
  grid.cloth.pins = {NamedPin::top_left};
  return {hanging_sheet(5), grid, mesh};
}

TEST(StepObjective, IsTheInertialTermAndTheElasticEnergy) {
  Random random;
  for (const Scene& scene : cloths_of_every_energy(random)) {
    const ClothSystem system = make_cloth(scene);
    constexpr double h = 0.01;
    const ClothState start = crumpled_state(system, 0.005, 0.3, random);
    const Vec3Field predicted = crumpled_state(system, 0.005, 0.3, random).velocity;
    const StepObjective objective(system, h, system.mass, start.position, predicted);
    const auto whole = [&](const Vec3Field& velocity) {
      ClothState end = start;
      double sum = 0;
      for (std::size_t i = 0; i < velocity.size(); ++i) {
        end.position.add(i, h * velocity[i]);
        if (!system.pinned[i])
          sum += system.mass[i] / (2 * h * h) * (h * (velocity[i] - predicted[i])).squaredNorm();
      }
      return sum + measure_energy(system, Vec3::Zero(), end).elastic;
    };
    const Vec3Field one = crumpled_state(system, 0.005, 0.5, random).velocity;
    const Vec3Field other = crumpled_state(system, 0.005, 0.5, random).velocity;
    const double expected = whole(one) - whole(other);
    EXPECT_NEAR(objective.difference(one, other), expected,
                1e-12 * std::abs(whole(one)) + 1e-12 * std::abs(whole(other)));
    EXPECT_EQ(objective.difference(one, one), 0);
    EXPECT_DOUBLE_EQ(objective.difference(other, one), -objective.difference(one, other));
  }
}

TEST(StepObjective, HasTheStepEquationsAsItsSlope) {
  Random random;
  for (const Scene& scene : cloths_of_every_energy(random)) {
    DirectRun run(scene, "verlet");
    constexpr double h = 0.01;
    const ClothState start = crumpled_state(run.system, 0.005, 0.3, random);
    Vec3Field predicted = start.velocity;
    for (std::size_t i = 0; i < predicted.size(); ++i) predicted.add(i, h * gravity_of(scene));
    const StepObjective objective(run.system, h, run.system.mass, start.position, predicted);
    const Vec3Field velocity = crumpled_state(run.system, 0.005, 0.5, random).velocity;
    Vec3Field end = start.position, force(end.size());
    add_scaled(h, velocity, end);
    run.forces.update(end, h);
    run.forces.force(end, velocity, force);
    for (const std::size_t i : {std::size_t{1}, std::size_t{7}, std::size_t{12}}) {
      const Vec3 residual = run.system.mass[i] * (velocity[i] - start.velocity[i]) - h * force[i];
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 shift = Vec3::Zero();
        shift[axis] = 1e-4;
        Vec3Field more = velocity, less = velocity;
        more.add(i, shift), less.add(i, -shift);
        EXPECT_NEAR(objective.difference(more, less) / 2e-4, residual[axis], 1e-6 * residual.norm() + 1e-9);
      }
    }
  }
}

TEST(IterationsStudy, SeesEveryMethodFallToTheSolutionOfNewtons) {
  IterationsOptions options;
  options.step = 0.005, options.time = 0.1, options.repeats = 1, options.most = 2000;
  const IterationsStudy study = run_iterations_study(hanging_sheet(9), options);
  ASSERT_EQ(study.failure, "");
  EXPECT_TRUE(study.is_minimum);
  EXPECT_GT(study.fall, 0);
  EXPECT_LT(study.floor, 1e-12);
  EXPECT_TRUE(study.left_out.empty());
  ASSERT_EQ(study.methods.size(), iterated_methods().size());
  for (const MethodIterations& method : study.methods) {
    ASSERT_FALSE(method.steps.empty());
    EXPECT_GT(method.steps.front().objective, 1e-8) << method.method << ": nothing to converge";
    for (const IteratedStep& step : method.steps) {
      EXPECT_GE(step.objective, -study.floor) << method.method << " " << step.iterations;
      EXPECT_GT(step.seconds, 0);
    }
    ASSERT_TRUE(first_below(method, 1e-10)) << method.method;
    EXPECT_LT(method.steps.back().objective, 1e-10) << method.method;
  }
  // Each iteration of Newton's is worth many of the others.
  const auto needs = [&](std::size_t k) { return first_below(study.methods[k], 1e-8)->iterations; };
  EXPECT_LT(needs(0), needs(1));
  EXPECT_LT(needs(0), needs(3));
}

TEST(IterationsStudy, NamesWhatItLeavesOut) {
  Scene scene = builtin_scene("flag");
  std::vector<std::string> left_out;
  const Scene studied = scene_of_iterations(scene, left_out);
  EXPECT_FALSE(studied.air);
  EXPECT_EQ(std::count(left_out.begin(), left_out.end(), "air"), 1);
  left_out.clear();
  EXPECT_TRUE(scene_of_iterations(builtin_scene("ball"), left_out).obstacles.empty());
  EXPECT_EQ(std::count(left_out.begin(), left_out.end(), "obstacles"), 1);
}

TEST(IterationsStudy, StopsWhenAskedAndSaysWhatCannotBeStudied) {
  IterationsOptions options;
  options.stop = [] { return true; };
  EXPECT_TRUE(run_iterations_study(hanging_sheet(5), options).stopped);
  Scene loose = hanging_sheet(5);
  loose.springs.reset();
  EXPECT_FALSE(find_problems(loose, {}).empty());
  EXPECT_FALSE(find_problems(hanging_sheet(5), {.step = -1.0}).empty());
  EXPECT_TRUE(find_problems(hanging_sheet(5), {}).empty());
  Scene still = hanging_sheet(5);
  still.gravity.reset();
  const IterationsStudy study = run_iterations_study(still, {.time = 0});
  EXPECT_NE(study.failure, "");
  EXPECT_NE(study_text(study).find("nothing to measure against"), std::string::npos);
}

TEST(IterationsStudy, ReportsWhatItMeasured) {
  IterationsOptions options;
  options.step = 0.005, options.time = 0.05, options.repeats = 1, options.most = 8;
  const IterationsStudy study = run_iterations_study(hanging_sheet(5), options);
  const CsvTable table = table_of(study);
  std::size_t rows = 0;
  for (const MethodIterations& method : study.methods) rows += method.steps.size();
  EXPECT_EQ(table.rows.size(), rows);
  EXPECT_EQ(parse_csv(csv_text(table, "\r\n")).rows, table.rows);
  for (const IterationsAgainst against : {IterationsAgainst::iterations, IterationsAgainst::time}) {
    const LinePlot plot = study_plot(study, against);
    ASSERT_EQ(plot.series.size(), study.methods.size());
    EXPECT_EQ(plot.series[0].points.size(), study.methods[0].steps.size());
    ASSERT_TRUE(plot.floor);
    EXPECT_EQ(plot.floor->y, study.floor);
  }
  EXPECT_NE(study_page(study, "command").find("Newton&#39;s method"), std::string::npos);
  EXPECT_NE(study_json(study).find("\"relative_objective\""), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::iterations_test
