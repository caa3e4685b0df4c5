// What probes measure, by hand on simple shapes and by what must not change it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "cloth/grid.h"
#include "measure/probe_measures.h"
#include "measure/probe_reader.h"
#include "scene/scene_cloth.h"
#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test::probe_test {
namespace {

using std::numbers::pi;

/// 3 x 5 particles 1 m apart in the x-z plane at height 2 m, held by its left edge.
Scene level_scene() {
  Scene scene;
  scene.cloth.rows = 3, scene.cloth.columns = 5;
  scene.cloth.width = 4, scene.cloth.height = 2;
  scene.cloth.mass = 15;
  scene.cloth.origin = {0, 2, 0};
  scene.cloth.across = {1, 0, 0}, scene.cloth.down = {0, 0, 1};
  scene.cloth.pins = {NamedPin::left_edge};
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

Probe probe(ProbeMeasure measure, std::vector<ParticlePlace> particles = {}) {
  return {.name = "p", .measure = measure, .particles = std::move(particles)};
}

std::vector<double> read(Scene scene, const Probe& one, const std::function<void(ClothState&)>& change = {}) {
  scene.probes = {one};
  const ClothSystem system = make_cloth(scene);
  ClothState state = starting_state(system);
  if (change) change(state);
  const ProbeReader reader(scene, system);
  std::vector<double> values = reader.read(system, state);
  EXPECT_EQ(values.size(), reader.columns().size());
  EXPECT_EQ(values.size(), facts_of(one.measure).values.size());
  return values;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected,
                 double tolerance = 1e-14) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    if (std::isnan(expected[k]))
      EXPECT_TRUE(std::isnan(found[k])) << k << ": " << found[k];
    else
      EXPECT_NEAR(found[k], expected[k], tolerance) << k;
}

TEST(AProbe, OfAParticleReadsItsPlaceItsSpeedAndItsDepthBelowThePins) {
  expect_near(read(level_scene(), probe(ProbeMeasure::particle, {{1, 4}}),
                   [](ClothState& state) {
                     state.position.set(9, {4, 0.5, 1});
                     state.velocity.set(9, {2, -3, 6});
                   }),
              {4, 0.5, 1, 7, 1.5});
}

TEST(AProbe, HasNoSagWhereNothingIsPinned) {
  Scene scene = level_scene();
  scene.cloth.pins.clear();
  expect_near(read(scene, probe(ProbeMeasure::particle, {{0, 0}})), {0, 2, 0, 0, NAN});
  expect_near(read(scene, probe(ProbeMeasure::droop)), {NAN, NAN, NAN});
}

TEST(AProbe, OfADistanceComparesItWithThatAtTheStart) {
  expect_near(read(level_scene(), probe(ProbeMeasure::distance, {{0, 0}, {0, 3}}),
                   [](ClothState& state) {
                     state.position.set(3, {3, -2, 0});
                   }),
              {5, 5.0 / 3 - 1});
}

TEST(AProbe, OfAnAngleIsAtItsSecondParticle) {
  const Probe corner = probe(ProbeMeasure::angle, {{0, 1}, {1, 1}, {1, 2}});
  expect_near(read(level_scene(), corner), {pi / 2, std::sqrt(2.0)});
  const Probe straight = probe(ProbeMeasure::angle, {{1, 0}, {1, 1}, {1, 4}});
  expect_near(read(level_scene(), straight), {pi, 0});
}

TEST(AProbe, OfALineTakesAllParticlesBetweenItsEnds) {
  Scene scene = level_scene();
  for (const auto& [ends, particles] :
       {std::pair{std::vector<ParticlePlace>{{1, 3}, {1, 0}}, std::vector<int>{8, 7, 6, 5}},
        {{{0, 2}, {2, 2}}, {2, 7, 12}},
        {{{2, 1}, {0, 3}}, {11, 7, 3}}})
    EXPECT_EQ(probed_particles(scene.cloth, probe(ProbeMeasure::line, ends)), particles);
  // Two hangs of 3, 4, 5 from a level line.
  expect_near(read(scene, probe(ProbeMeasure::line, {{1, 0}, {1, 4}}),
                   [](ClothState& state) {
                     state.position.set(5, {0, 2, 1});
                     state.position.set(6, {3, -2, 1});
                     state.position.set(7, {6, 2, 1});
                     state.position.set(8, {9, -2, 1});
                     state.position.set(9, {12, 2, 1});
                   }),
              {20, 4, 4, 2 * 24 / (5.0 * 5 * 6), 0}, 1e-13);
}

TEST(AProbe, OfALineCountsItsFoldsToEitherSide) {
  Scene scene = level_scene();
  scene.cloth.columns = 101;
  const Probe hem = probe(ProbeMeasure::line, {{2, 0}, {2, 100}});
  for (const int waves : {1, 2, 5})
    for (const double amplitude : {0.3, -0.3}) {
      const auto wave = [&](ClothState& state) {
        for (int i = 0; i <= 100; ++i)
          state.position.set(static_cast<std::size_t>(202 + i),
                             {i * 0.01, 0, amplitude * std::sin(2 * pi * waves * i / 100)});
      };
      EXPECT_EQ(read(scene, hem, wave)[4], waves);
      EXPECT_EQ(read(scene, probe(ProbeMeasure::line, {{2, 100}, {2, 0}}), wave)[4], waves) << "from behind";
    }
  EXPECT_EQ(read(scene, hem)[4], 0) << "straight";
}

TEST(AProbe, OfALineThatHangsStraightDownHasNeitherSagNorFolds) {
  Scene scene = level_scene();
  scene.cloth.down = {0, -1, 0};
  expect_near(read(scene, probe(ProbeMeasure::line, {{0, 1}, {2, 1}})), {2, 0, NAN, 0, NAN});
  expect_near(read(scene, probe(ProbeMeasure::line, {{0, 1}, {0, 2}})), {1, 0, 0, NAN, 0});
}

TEST(AProbe, OfTheShapeReadsTheWholeCloth) {
  const auto lower_last = [](ClothState& state) { state.position.add(14, {0, -1.5, 0}); };
  expect_near(read(level_scene(), probe(ProbeMeasure::lowest_point), lower_last), {0.5});
  expect_near(read(level_scene(), probe(ProbeMeasure::extent), lower_last), {4, 1.5, 2});
  expect_near(read(level_scene(), probe(ProbeMeasure::shadow), lower_last), {8}, 1e-12);
  expect_near(read(level_scene(), probe(ProbeMeasure::droop), lower_last), {1.5, 4, 1.5 / 4});
}

TEST(AProbe, OfRestAsksTheKineticEnergy) {
  Probe rest = probe(ProbeMeasure::rest);
  const auto move = [](ClothState& state) { state.velocity.set(7, {0.2, 0, 0}); };  // 1 kg: 0.02 J
  rest.bound = 0.02001;
  EXPECT_EQ(read(level_scene(), rest, move)[0], 1);
  rest.bound = 0.01999;
  EXPECT_EQ(read(level_scene(), rest, move)[0], 0);
}

TEST(AProbe, OfDrapeIsCusicksMeasure) {
  Scene scene = level_scene();
  scene.cloth.pins.clear();
  Probe drape = probe(ProbeMeasure::drape);
  drape.radius = 0.5;
  const std::vector<double> flat = read(scene, drape);
  EXPECT_NEAR(flat[0], 1, 1e-3);
  EXPECT_EQ(flat[1], 0);
  const auto shrink = [](ClothState& state) {  // to the shadow of half the sides
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      const Vec3 at = state.position[i];
      state.position.set(i, {2 + (at.x() - 2) / 2, at.y() - 0.3, 1 + (at.z() - 1) / 2});
    }
  };
  const double disc = pi / 4;
  EXPECT_NEAR(read(scene, drape, shrink)[0], (2 - disc) / (8 - disc), 1e-3);
}

TEST(MeasuresOfPoints, DoNotChangeWhenAllIsTurnedAndMoved) {
  Random random;
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points, moved;
    for (int k = 0; k < 6; ++k) points.push_back(random.vector(1));
    const Vec3 up = random.vector(1).normalized(), by = random.vector(3);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(-3, 3), random.vector(1).normalized()).toRotationMatrix();
    for (const Vec3& point : points) moved.emplace_back(turn * point + by);
    const Vec3 turned_up = turn * up;
    EXPECT_NEAR(angle_at(points[0], points[1], points[2]), angle_at(moved[0], moved[1], moved[2]), 1e-12);
    const double curvature = largest_curvature(points);
    EXPECT_NEAR(largest_curvature(moved), curvature, 1e-10 * curvature);
    EXPECT_NEAR(length_of(moved), length_of(points), 1e-12);
    const double sag = sag_below_chord(points, up);
    EXPECT_NEAR(sag_below_chord(moved, turned_up), sag, 1e-9 * (1 + sag));
    EXPECT_EQ(folds_along(moved, turned_up, 0.1), folds_along(points, up, 0.1));
  }
}

TEST(MeasuresOfPoints, DoNotChangeWhenTheyAreGoneThroughBackwards) {
  Random random;
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points;
    for (int k = 0; k < 7; ++k) points.push_back(random.vector(1));
    const std::vector<Vec3> back(points.rbegin(), points.rend());
    const Vec3 up(0, 1, 0);
    EXPECT_NEAR(length_of(back), length_of(points), 1e-13);
    EXPECT_NEAR(largest_curvature(back) / largest_curvature(points), 1, 1e-12);
    EXPECT_NEAR(sag_below_chord(back, up), sag_below_chord(points, up), 1e-9);
    EXPECT_EQ(folds_along(back, up, 1e-3), folds_along(points, up, 1e-3));
  }
}

TEST(Curvature, OfACircleIsExactHoweverFarItsPointsAreApart) {
  const auto at = [](double angle) { return Vec3(3 + 2 * std::cos(angle), 2 * std::sin(angle), 1); };
  Random random;
  for (int round = 0; round < 20; ++round) {
    const double a = random.uniform(0, 2), b = a + random.uniform(0.1, 2), c = b + random.uniform(0.1, 2);
    EXPECT_NEAR(curvature_through(at(a), at(b), at(c)), 0.5, 1e-12);
  }
}

TEST(Curvature, OfACurveIsOfOrderTwoInTheStep) {
  const auto at = [](double x) { return Vec3(x, std::sin(2 * x), 0); };
  const double x = 0.6, slope = 2 * std::cos(2 * x);
  const double exact = 4 * std::sin(2 * x) / std::pow(1 + slope * slope, 1.5);
  const auto error = [&](double h) {
    return std::abs(curvature_through(at(x - h), at(x), at(x + h)) - exact);
  };
  for (const double h : {0.04, 0.02, 0.01}) {
    const double order = std::log2(error(h) / error(h / 2));
    EXPECT_GT(order, 1.9) << h;
    EXPECT_LT(order, 2.1) << h;
  }
}

TEST(Curvature, OfAStraightLineIsNoneAndOfOnePointTwiceNotANumber) {
  EXPECT_EQ(curvature_through({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), 0);
  EXPECT_TRUE(std::isnan(curvature_through({0, 0, 0}, {1, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(std::isnan(angle_at({0, 0, 0}, {0, 0, 0}, {1, 0, 0})));
}

TEST(Sag, OfACatenaryIsThatOfItsFormula) {
  const double a = 0.7, half = 1.3;
  std::vector<Vec3> points;
  for (int k = -50; k <= 50; ++k) {
    const double x = half * k / 50;
    points.emplace_back(x, a * std::cosh(x / a), 0);
  }
  EXPECT_NEAR(sag_below_chord(points, {0, 1, 0}), a * (std::cosh(half / a) - 1), 1e-12);
  EXPECT_EQ(sag_below_chord(points, {0, -1, 0}), 0) << "nothing hangs upwards";
}

TEST(ProbeColumns, AreNamedByProbeAndValueWithItsUnit) {
  EXPECT_EQ(probe_columns({{.name = "tip", .measure = ProbeMeasure::particle, .particles = {{0, 0}}},
                           {.name = "calm", .measure = ProbeMeasure::rest}}),
            std::vector<std::string>({"probe.tip.x_m", "probe.tip.y_m", "probe.tip.z_m",
                                      "probe.tip.speed_m_s", "probe.tip.sag_m", "probe.calm.at_rest"}));
}

TEST(ProbeColumns, SayTheirLabelAndUnitByThemselves) {
  for (const ProbeFacts& facts : probe_facts())
    for (const ProbeValue& value : facts.values) {
      const auto words = words_of_probe_column(probe_column({.name = "a-b"}, value));
      ASSERT_TRUE(words);
      EXPECT_EQ(words->label, std::string("a-b: ") + value.label) << "the key stands for one thing alone";
      EXPECT_EQ(words->unit, value.unit);
    }
  EXPECT_FALSE(words_of_probe_column("kinetic_J"));
  EXPECT_FALSE(words_of_probe_column("probe.x_m"));
  EXPECT_FALSE(words_of_probe_column("probe.a.b_m"));
}

TEST(ProbeMeasures, StandInTheListAtTheirNumbersAndAreReadByEachName) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < probe_facts().size(); ++k) {
    EXPECT_EQ(static_cast<std::size_t>(probe_facts()[k].measure), k);
    EXPECT_TRUE(names.insert(probe_facts()[k].name).second);
  }
}

}  // namespace
}  // namespace cloth::test::probe_test
