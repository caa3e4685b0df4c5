// The benchmark's parts: nothing here depends on how fast the machine is.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/speed/reference_kernel.h"
#include "bench/speed/scalar_roots.h"
#include "bench/speed/speed_study.h"
#include "bench/speed/speed_tables.h"
#include "integrators/registry.h"
#include "report/text_table.h"
#include "scene/builtin_scenes.h"

namespace cloth::speed::speed_test {
namespace {

StepCost row_of(int size, const std::string& method, double nanoseconds) {
  return {.size = size,
          .method = method,
          .feature = "bare",
          .samples = 1,
          .time = {nanoseconds, nanoseconds, nanoseconds}};
}

TEST(Growth, OfAPowerOfTheParticlesIsThatPower) {
  std::vector<StepCost> rows;
  for (const int size : {32, 64, 128, 256}) {
    rows.push_back(row_of(size, "verlet", 10));
    rows.push_back(row_of(size, "implicit-euler", 0.5 * size));  // per particle: N^3 in all
  }
  const std::vector<Growth> growth = fit_growth(rows);
  ASSERT_EQ(growth.size(), 2u);
  EXPECT_EQ(growth[0].method, "verlet");
  EXPECT_NEAR(growth[0].exponent.value, 1, 1e-12);
  EXPECT_NEAR(growth[0].exponent.standard_error, 0, 1e-6);
  EXPECT_NEAR(growth[1].exponent.value, 1.5, 1e-12);
  EXPECT_EQ(growth[1].smallest, 32);
  EXPECT_EQ(growth[1].largest, 256);
}

TEST(Growth, IsThatOfAnInnerStepWhereAStepTakesSeveral) {
  std::vector<StepCost> rows;
  for (const int size : {32, 64, 128}) {
    rows.push_back(row_of(size, "dormand-prince", 10.0 * size));
    rows.back().inner_steps = size;
  }
  EXPECT_NEAR(fit_growth(rows).at(0).exponent.value, 1, 1e-12);
}

TEST(Growth, NeedsTwoSizesThatWereTimed) {
  StepCost left_out = row_of(64, "verlet", 0);
  left_out.samples = 0;
  EXPECT_TRUE(fit_growth({row_of(32, "verlet", 10), left_out}).empty());
  EXPECT_TRUE(fit_growth({}).empty());
}

TEST(Growth, KeepsFeaturesAndThreadsApart) {
  std::vector<StepCost> rows;
  for (const int size : {32, 64})
    for (const int threads : {1, 2}) {
      rows.push_back(row_of(size, "verlet", threads == 1 ? 10 : 0.1 * size));
      rows.back().threads = threads;
    }
  const std::vector<Growth> growth = fit_growth(rows);
  ASSERT_EQ(growth.size(), 2u);
  EXPECT_NEAR(growth[0].exponent.value, 1, 1e-12);
  EXPECT_NEAR(growth[1].exponent.value, 1.5, 1e-12);
}

TEST(InterleavedTiming, ComparesWhatStoodSideBySide) {
  Subject first{.name = "first", .run = {}}, second{.name = "second", .run = {}};
  first.samples = {{0, 2.0}, {1, 20.0}, {2, 200.0}};
  second.samples = {{0, 1.0}, {1, 10.0}};
  const Spread ratio = ratio_of(first, second);
  EXPECT_EQ(ratio.low, 2);
  EXPECT_EQ(ratio.median, 2);
  EXPECT_EQ(ratio.high, 2);
  EXPECT_EQ(spread_of(std::vector<double>{4, 1, 3, 2, 5}).median, 3);
  EXPECT_EQ(spread_of(std::vector<double>{4, 1, 3, 2, 5}).low, 2);
}

TEST(InterleavedTiming, TakesEverySampleAndDropsWhatBreaksDown) {
  int runs = 0;
  std::vector<Subject> subjects;
  subjects.push_back({"steady", 1, [&](int times) { return (runs += times) > 0; }});
  subjects.push_back({"breaks", 1, [&](int) { return false; }});
  ASSERT_TRUE(time_interleaved(subjects, {.repeats = 5, .moment = 1e-5, .budget = 10}, {}));
  EXPECT_EQ(subjects[0].samples.size(), 5u);
  EXPECT_GT(runs, 5);
  EXPECT_TRUE(subjects[1].broken);
  EXPECT_TRUE(subjects[1].samples.empty());
}

TEST(InterleavedTiming, EndsWhenItIsTold) {
  std::vector<Subject> subjects;
  subjects.push_back({"steady", 1, [](int) { return true; }});
  EXPECT_FALSE(time_interleaved(subjects, {.repeats = 5, .moment = 1e-5},
                                [](double, const std::string&) { return false; }));
}

TEST(Yardsticks, AreFiniteAndPositive) {
  const Yardsticks y = measure_yardsticks(
      {.timing = {.repeats = 3, .moment = 1e-4, .budget = 1}, .array_bytes = std::size_t{1} << 16});
  for (const Spread& spread : {y.scalar_root, y.vector_root, y.triad, y.update, y.together})
    for (const double value : {spread.low, spread.median, spread.high}) {
      EXPECT_TRUE(std::isfinite(value));
      EXPECT_GT(value, 0);
    }
  EXPECT_GT(y.update_throughput(), 0);
  EXPECT_GT(divider_floor(y, 6, 1), 0);
  EXPECT_DOUBLE_EQ(divider_floor(y, 6, 4), 4 * divider_floor(y, 6, 1));
  EXPECT_DOUBLE_EQ(memory_floor(y), 4 * y.update.median) << "96 bytes are four elements of 24";
}

TEST(Yardsticks, TakeRealRoots) {
  const double x[] = {0.25, 1, 16, 2};
  double y[4];
  scalar_roots(x, y, 4);
  EXPECT_EQ(y[0], 2);
  EXPECT_EQ(y[2], 0.25);
  EXPECT_EQ(y[3], 1 / std::sqrt(2.0));
}

TEST(ReferenceKernel, IsSemiImplicitEuler) {
  const Scene scene = hanging_cloth(12, "semi-implicit-euler", feature_named("damping"));
  Simulation simulation(scene);
  DevelopedCloth(feature_named("damping")).put_into(simulation);
  ReferenceKernel kernel(scene, simulation.system(), simulation.state());
  for (int k = 0; k < 50; ++k) {
    kernel.step(simulation.time_step());
    ASSERT_FALSE(simulation.step());
  }
  EXPECT_LT(kernel.distance_to(simulation.state().position), 1e-12);
  EXPECT_GT(kernel.distance_to(simulation.system().start), 1e-4) << "nothing moved";
}

TEST(DevelopedCloth, HasOneShapeAtEverySize) {
  const DevelopedCloth cloth(bare_feature());
  Simulation small(hanging_cloth(32, "verlet", bare_feature()));
  Simulation large(hanging_cloth(63, "verlet", bare_feature()));
  cloth.put_into(small);
  cloth.put_into(large);
  for (const int row : {0, 7, 31})
    for (const int column : {0, 12, 31}) {
      const auto i = static_cast<std::size_t>(small.system().index(row, column));
      const auto j = static_cast<std::size_t>(large.system().index(2 * row, 2 * column));
      EXPECT_LT((small.state().position[i] - large.state().position[j]).norm(), 1e-12);
      EXPECT_LT((small.state().velocity[i] - large.state().velocity[j]).norm(), 1e-12);
    }
  EXPECT_GT(small.measure().strain.maximum(), 0.01) << "the springs pull";
}

TEST(SpeedStudy, WantsEveryMethodBareAndTwoWithEveryFeature) {
  SpeedOptions options;
  options.threads = {1, 2};
  const auto wants = [&](int size, const Wanted& row) {
    const std::vector<Wanted> rows = wanted_rows(options, size);
    return std::find(rows.begin(), rows.end(), row) != rows.end();
  };
  for (const std::string& method : integrator_names()) EXPECT_TRUE(wants(64, {method, "bare", 1})) << method;
  EXPECT_TRUE(wants(64, {"verlet", "limit-1", 2}));
  EXPECT_FALSE(wants(64, {"rk4", "limit-1", 1}));
  EXPECT_FALSE(wants(512, {"implicit-euler", "bare", 1})) << "hours";
  EXPECT_TRUE(wants(512, {"rk4", "bare", 1}));
  options.methods = {"rk4"};
  options.features = {"air"};
  options.sizes = {512};
  EXPECT_TRUE(wants(512, {"rk4", "air", 1}));
  EXPECT_TRUE(wants(512, {"rk4", "bare", 1})) << "ratios need it";
  EXPECT_FALSE(wants(512, {"rk4", "sphere", 1}));
  EXPECT_FALSE(wants(512, {"verlet", "bare", 1}));
}

TEST(SceneSpeeds, RefineAGridInItsProportionsAndLeaveAStableStep) {
  const Scene flag = builtin_scene("flag");
  std::string why;
  const auto same = refined(flag, 40, why), finer = refined(flag, 79, why), coarser = refined(flag, 14, why);
  ASSERT_TRUE(same && finer && coarser) << why;
  EXPECT_EQ(same->cloth, flag.cloth);
  EXPECT_EQ(same->integrator, flag.integrator);
  EXPECT_EQ(finer->cloth.columns, 79);
  EXPECT_EQ(finer->cloth.rows, 49);
  EXPECT_EQ(coarser->cloth.columns, 14);
  EXPECT_EQ(coarser->cloth.rows, 9);
  EXPECT_EQ(refined(flag, 257, why)->integrator.time_step, std::nullopt) << "auto";
  EXPECT_FALSE(refined(builtin_scene("disc"), 33, why));
  EXPECT_NE(why.find("mesh"), std::string::npos) << why;
}

TEST(SceneGrowth, IsThePowerOfTheParticlesByWhichAStepGrows) {
  std::vector<SceneSpeed> rows;
  for (const int particles : {100, 400, 1600}) {
    rows.push_back({.name = "linear", .particles = particles, .nanoseconds = 20});
    rows.push_back({.name = "steep", .particles = particles, .nanoseconds = 0.1 * std::sqrt(particles)});
  }
  rows.push_back({.name = "once", .particles = 100, .nanoseconds = 5});
  const std::vector<SceneGrowth> growth = fit_scene_growth(rows);
  ASSERT_EQ(growth.size(), 2u);
  EXPECT_NEAR(growth[0].exponent.value, 1, 1e-12);
  EXPECT_NEAR(growth[1].exponent.value, 1.5, 1e-12);
  EXPECT_EQ(growth[1].smallest, 100);
  EXPECT_EQ(growth[1].largest, 1600);
}

TEST(SpeedStudy, ThatIsEndedKeepsWhatWasFinished) {
  SpeedOptions options;
  options.quick = true;
  options.parts = {"scenes", "memory"};
  options.methods = {"verlet"};
  options.features = {"air"};
  options.progress = [](double, const std::string& text) { return text.rfind("scene", 0) != 0; };
  const SpeedReport report = study_speed(options);
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.memory.size(), 2u) << "bare, and with air";
  EXPECT_TRUE(report.scenes.empty());
  EXPECT_NE(speed_text(report).find("Interrupted"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(speed_json(report))["complete"], false);
}

TEST(Memory, OfASimulationIsAtLeastItsState) {
  const MemoryCost cost = measure_memory("semi-implicit-euler", "bare", 64);
  if (!cost.held) GTEST_SKIP() << "this C library does not count";
  EXPECT_GT(*cost.held, 6 * 8) << "six numbers of eight bytes";
}

/// On a grid, whatever the scene has; a deformation rate takes tensions of four springs for each particle and
/// the equations for them.
TEST(Memory, OfAnExplicitMethodIsAtMostTwoHundredBytesForEachParticleAndSixHundredForItsTensions) {
  for (const char* method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"})
    for (const Feature& feature : features()) {
      const MemoryCost cost = measure_memory(method, feature.name, 128);
      if (!cost.held) GTEST_SKIP() << "this C library does not count";
      const bool limited = feature.name.rfind("limit", 0) == 0;
      EXPECT_LE(*cost.held, limited ? 800 : 200) << method << " with " << feature.name;
    }
}

TEST(Start, OfWhatDoesNotExistSaysSo) {
  const StartCost cost = measure_start("nothing", "/nowhere/at-all", {}, 3);
  EXPECT_EQ(cost.samples, 0);
  EXPECT_FALSE(cost.remark.empty());
}

TEST(TextTable, AlignsItsColumnsAndLeavesOutEmptyOnes) {
  const TextTable table{.columns = {{"Name"}, {"Time (µs)", true}, {"Nothing"}, {"Last"}},
                        .rows = {{"a", "1", "", "x"}, {"long name", "22"}}};
  EXPECT_EQ(to_text(table),
            "Name       Time (µs)  Last\n"
            "a                  1  x\n"
            "long name         22\n");
  EXPECT_EQ(to_markdown(table),
            "| Name | Time (µs) | Last |\n|---|--:|---|\n| a | 1 | x |\n| long name | 22 |  |\n");
}

}  // namespace
}  // namespace cloth::speed::speed_test
