// Probes as a block of the scene: what a file may say, and what a run records of them.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/comparison.h"
#include "integrators/registry.h"
#include "measure/probe_reader.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_checks.h"
#include "scene/scene_edits.h"
#include "scene/scene_json.h"
#include "simulation/recorder.h"
#include "simulation/session.h"
#include "study/run_output.h"
#include "study/refined_scene.h"
#include "support/scenes.h"

namespace cloth::test::scene_probes_test {
namespace {

using Texts = std::vector<std::string>;

Texts problems_of(const std::string& probes, const std::string& cloth = R"("rows": 5, "columns": 4)") {
  Texts texts;
  for (const Problem& problem :
       read_scene("{\"cloth\": {" + cloth + "},\n\"probes\": [" + probes + "]}", "name").problems)
    texts.push_back(problem.text());
  return texts;
}

/// A probe of each measure.
std::vector<Probe> every_probe() {
  std::vector<Probe> probes;
  for (const ProbeFacts& facts : probe_facts()) {
    Probe& probe = probes.emplace_back(Probe{.name = facts.name, .measure = facts.measure});
    for (std::size_t k = 0; k < facts.least_particles; ++k)
      probe.particles.push_back({0, static_cast<int>(2 * k)});
    if (facts.measure == ProbeMeasure::drape) probe.radius = 0.05;
    if (facts.measure == ProbeMeasure::rest) probe.bound = 1e-3;
  }
  return probes;
}

Scene probed_scene() {
  Scene scene = smooth_scene(6, 6);
  scene.probes = every_probe();
  scene.integrator.time_step = 0.001;
  scene.duration = 0.05;
  return scene;
}

TEST(SceneOfProbes, ReadsBackEqual) {
  const Scene scene = probed_scene();
  const SceneReading reading = read_scene(write_scene(scene), "name");
  ASSERT_TRUE(reading.scene) << reading.problems.front().text() << write_scene(scene);
  EXPECT_EQ(*reading.scene, scene);
  Scene mesh = builtin_scene("disc");
  mesh.probes = {{.name = "chain", .measure = ProbeMeasure::line, .particles = {{0, 3}, {0, 7}, {0, 5}}}};
  ASSERT_TRUE(find_problems(mesh).empty());
  const SceneReading again = read_scene(write_scene(mesh), "", {}, {mesh.folder, &mesh});
  ASSERT_TRUE(again.scene) << again.problems.front().text();
  EXPECT_EQ(*again.scene, mesh);
}

TEST(SceneOfProbes, WithoutAnyHasNoWordOfThem) {
  EXPECT_EQ(write_scene(smooth_scene(4, 4)).find("probe"), std::string::npos);
}

TEST(SceneOfProbes, NamesPlaceValueAndRuleOfWhatIsWrong) {
  const auto is = [](const std::string& probes, const std::string& text) {
    EXPECT_EQ(problems_of(probes), Texts({text}));
  };
  is(R"({"name": "a", "measure": "particle", "particles": [[5, 0]]})",
     "name:2:63: probes.0.particles.0 = [5, 0]: must lie in the grid: row 0 to 4, column 0 to 3");
  is(R"({"name": "a", "measure": "particle", "particles": [7]})",
     "name:2:63: probes.0.particles.0 = 7: must be [row, column] in whole numbers");
  is(R"({"name": "a", "measure": "angle", "particles": [[0, 0], [1, 1]]})",
     "name:2:59: probes.0.particles = 2 given: must be three particles");
  is(R"({"name": "a", "measure": "distance", "particles": [[1, 1], [1, 1]]})",
     "name:2:71: probes.0.particles.1 = [1, 1]: must be another particle than probes.0.particles.0");
  is(R"({"name": "a", "measure": "line", "particles": [[0, 0], [3, 1]]})",
     "name:2:67: probes.0.particles.1 = [3, 1]: must lie in one row, column or diagonal with [0, 0]");
  is(R"({"name": "a", "measure": "line", "particles": [[0, 0], [0, 1], [0, 2]]})",
     "name:2:58: probes.0.particles = 3 given: must be two particles: the ends of a row, a column or a "
     "diagonal of the grid");
  is(R"({"name": "a", "measure": "extent"}, {"name": "a", "measure": "shadow"})",
     "name:2:57: probes.1.name = \"a\": must be another name than that of probes.0");
  is(R"({"name": "1 a", "measure": "extent"})",
     "name:2:21: probes.0.name = \"1 a\": must be a letter and up to 31 letters, digits, - and _: it is part "
     "of a column's name");
  is(R"({"name": "a", "measure": "drape", "radius": 2})",
     "name:2:56: probes.0.radius = 2 m: must be less than 0.5642 m: a disc as large as the cloth leaves "
     "nothing that could hang");
  is(R"({"name": "a", "measure": "rest", "bound": 0})", "name:2:54: probes.0.bound = 0 J: must be > 0");
  is(R"({"name": "a", "measure": "extent", "particles": []})",
     "name:2:47: probes.0.particles: is not a known key; known here: measure, name");
  is(R"({"measure": "extent"})", "name:2:12: probes.0.name: must be given: its columns are called by it");
  is(R"({"name": "a", "measure": "size"})",
     "name:2:37: probes.0.measure = \"size\": must be \"particle\", \"distance\", \"angle\", \"line\", "
     "\"lowest-point\", \"extent\", \"shadow\", \"drape\", \"droop\" or \"rest\"");
}

TEST(SceneOfProbes, KnowsThatARoundClothHasNoCorner) {
  const std::string round = R"("rows": 9, "columns": 9, "cut": "round"}, "material": {"preset": "wool-tropical")";
  EXPECT_EQ(problems_of(R"({"name": "a", "measure": "particle", "particles": [[4, 4]]})", round), Texts());
  EXPECT_EQ(problems_of(R"({"name": "a", "measure": "particle", "particles": [[0, 0]]})", round),
            Texts({"name:2:63: probes.0.particles.0 = [0, 0]: must lie in the grid: row 0 to 8, column 0 to "
                   "8, where the cloth is not cut away"}));
  Scene scene = builtin_scene("cusick-interlock");
  const int middle = scene.cloth.rows / 2;
  scene.probes = {{.name = "a", .measure = ProbeMeasure::particle, .particles = {{middle, middle}}}};
  const Simulation simulation(scene);
  const std::vector<double> at = simulation.measure().probes;
  const Vec3 expected = scene.cloth.origin + 0.5 * scene.cloth.width * scene.cloth.across.normalized() +
                        0.5 * scene.cloth.height * scene.cloth.down.normalized();
  EXPECT_NEAR((Vec3(at[0], at[1], at[2]) - expected).norm(), 0, 1e-12);
}

TEST(SceneOfProbes, TellsOfADroopWithoutPins) {
  Scene scene = probed_scene();
  const auto tells = [](const Scene& of) {
    const std::vector<std::string> notices = scene_notices(of);
    return std::any_of(notices.begin(), notices.end(), [](const std::string& notice) {
      return notice == "probe droop: nothing is pinned, so that there is no droop to measure";
    });
  };
  scene.cloth.pins = {NamedPin::top_left};
  EXPECT_FALSE(tells(scene));
  scene.cloth.pins.clear();
  EXPECT_TRUE(tells(scene));
}

TEST(RecordOfProbes, HasTheirColumnsBeforeTheWallTime) {
  const Scene scene = probed_scene();
  Scene without = scene;
  without.probes.clear();
  std::vector<std::string> expected = record_columns(Simulation(without).quantities());
  for (const std::string& column : expected) EXPECT_EQ(column.find("probe"), std::string::npos);
  const std::vector<std::string> columns = probe_columns(scene.probes);
  expected.insert(expected.end() - 1, columns.begin(), columns.end());
  EXPECT_EQ(record_columns(Simulation(scene).quantities()), expected);
}

TEST(RecordOfProbes, EndsWithWhatTheFinalStateSays) {
  const Scene scene = probed_scene();
  std::vector<double> last;
  RunOptions options;
  options.row = [&](const Simulation&, const Measurement& row) { last = row.probes; };
  const RunResult run = run_scene(scene, options);
  const ClothSystem system = Simulation(scene).system();
  const std::vector<double> of_state = ProbeReader(scene, system).read(system, run.final_state);
  ASSERT_EQ(last.size(), of_state.size());
  int numbers = 0;
  for (std::size_t k = 0; k < last.size(); ++k) {
    EXPECT_EQ(std::isnan(last[k]), std::isnan(of_state[k]));
    if (std::isnan(last[k])) continue;
    ++numbers;
    EXPECT_EQ(last[k], of_state[k]);
  }
  EXPECT_GT(numbers, 15);
}

TEST(RecordOfProbes, LeavesACellEmptyWhereAValueIsNotDefined) {
  Scene scene = probed_scene();
  scene.cloth.pins.clear();
  scene.probes = {{.name = "d", .measure = ProbeMeasure::droop}};
  const Simulation simulation(scene);
  const auto row = record_row(simulation.measure(), simulation.quantities(), 0);
  EXPECT_EQ(std::vector<std::string>(row.end() - 4, row.end() - 1), Texts({"", "", ""}));
  EXPECT_TRUE(
      std::isnan(recorded_value("probe.d.ratio", simulation.measure(), simulation.quantities()).value()));
}

TEST(Motion, IsTheSameToTheBitWithProbesAndWhereverTheyAreAdded) {
  for (const std::string& method : integrator_names()) {
    Scene plain = probed_scene();
    plain.integrator.method = method;
    plain.probes.clear();
    Simulation without(plain), with(plain);
    for (int step = 0; step < 30; ++step) {
      if (step % 10 == 5) {
        Scene edited = plain;
        edited.probes = every_probe();
        edited.probes.resize(static_cast<std::size_t>(1 + step / 10));
        with.edit(edited);
        EXPECT_EQ(with.measure().probes.size(), probe_columns(edited.probes).size());
      }
      without.step();
      with.step();
    }
    EXPECT_EQ(without.state(), with.state()) << method;
    EXPECT_EQ(without.count().force_evaluations, with.count().force_evaluations) << method;
  }
}

TEST(ASessionOfProbes, ReplaysToTheBitAndRecordsThemFromWhereTheyCame) {
  Session session;
  session.scene = probed_scene();
  const std::vector<Probe> probes = session.scene.probes;
  session.scene.probes.clear();
  Scene edited = session.scene;
  edited.probes = probes;
  session.commands = {{5, 0.005, edits_between(session.scene, edited)},
                      {8, 0.008, edits_between(edited, session.scene)}};
  edited.probes.resize(1);
  session.commands.push_back({9, 0.009, edits_between(session.scene, edited)});
  session.steps = 20;
  const ReplayResult one = replay(session, {});
  EXPECT_TRUE(one.problems.empty());
  EXPECT_EQ(one.commands, 3u);
  Session plain = session;
  plain.commands.clear();
  EXPECT_EQ(one.run.final_state, replay(plain, {}).run.final_state);
}

TEST(EditsOfProbes, LeadFromOneSceneToTheOther) {
  Scene before = probed_scene(), after = before;
  after.probes[0].name = "other";
  after.probes.back().bound = 0.25;
  const auto edits = edits_between(before, after);
  ASSERT_EQ(edits.size(), 2u);
  EXPECT_EQ(edits[0].path, "probes.0.name");
  const SceneReading reading = edited_scene(before, edits);
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(*reading.scene, after);
  after.probes.clear();
  EXPECT_EQ(*edited_scene(before, edits_between(before, after)).scene, after);
}

TEST(PanesOfAComparison, ShareTheirProbes) {
  EXPECT_EQ(must_be_shared("probes.0.bound").value(), "must be shared: probes measure all panes alike");
}

TEST(GridConvergence, HasProbesAmongItsOutputsAndKeepsTheirPlaces) {
  Scene scene = probed_scene();
  scene.cloth.rows = scene.cloth.columns = 9;
  scene.cloth.pins = {NamedPin::top_left};
  scene.probes = {{.name = "middle", .measure = ProbeMeasure::particle, .particles = {{4, 4}}}};
  const std::vector<std::string> known = output_sources(scene);
  EXPECT_NE(std::find(known.begin(), known.end(), "probe.middle.sag_m"), known.end());
  EXPECT_EQ(unit_of_output("probe.middle.speed_m_s:max"), "m/s");
  EXPECT_EQ(cell_unit(scene), 2);
  const Scene fine = refined_scene(scene, 16);
  EXPECT_EQ(fine.probes[0].particles[0], (ParticlePlace{8, 8}));
  ASSERT_TRUE(find_problems(fine).empty());
  EXPECT_NEAR(Simulation(fine).measure().probes[1], Simulation(scene).measure().probes[1], 1e-14);
}

}  // namespace
}  // namespace cloth::test::scene_probes_test
