// What is written reads back equal, bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/start_check.h"
#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "support/random.h"

namespace cloth::test::scene_round_trip_test {
namespace {

void expect_reads_back(const Scene& scene) {
  const std::string text = write_scene(scene);
  const SceneReading reading = read_scene(text, "name");
  ASSERT_TRUE(reading.scene) << (reading.problems.empty() ? "" : reading.problems.front().text()) << "\n"
                             << text;
  EXPECT_EQ(*reading.scene, scene) << text;
  EXPECT_EQ(write_scene(*reading.scene), text);
}

TEST(BuiltinScenes, AreThoseOfTheDocumentation) {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  EXPECT_EQ(names, std::vector<std::string>({"ball",
                                             "ball-interlock",
                                             "bunny",
                                             "bunny-knit",
                                             "cantilever-paper",
                                             "corner",
                                             "corner-wool",
                                             "corners-free",
                                             "corners-shear",
                                             "corners-structural",
                                             "corners-target",
                                             "cube",
                                             "cube-ribbon",
                                             "curtain",
                                             "curtain-wool",
                                             "cusick-interlock",
                                             "disc",
                                             "disc-interlock",
                                             "fast-ball",
                                             "fast-ball-denim",
                                             "flag",
                                             "flag-cotton",
                                             "fold",
                                             "fold-ribbon",
                                             "free-fall",
                                             "pendulum",
                                             "rectangle",
                                             "rectangle-ponte",
                                             "slope",
                                             "slope-wool",
                                             "spikes",
                                             "spikes-swim",
                                             "tablecloth",
                                             "tablecloth-denim",
                                             "twist",
                                             "twist-ponte",
                                             "wind",
                                             "wind-denim"}));
}

TEST(BuiltinScenes, AllReadAndKeepEveryRule) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const SceneReading reading = read_scene(builtin.text, builtin.name);
    ASSERT_TRUE(reading.scene) << reading.problems.front().text();
    EXPECT_TRUE(find_problems(*reading.scene).empty());
    EXPECT_EQ(*reading.scene, builtin_scene(builtin.name));
    EXPECT_FALSE(reading.scene->title.empty()) << builtin.name;
    EXPECT_EQ(builtin.title, reading.scene->title);
  }
}

TEST(BuiltinScenes, ReadBackAfterWriting) {
  for (const BuiltinScene& builtin : builtin_scenes()) expect_reads_back(builtin_scene(builtin.name));
}

TEST(BuiltinScenes, AreFoundByName) {
  ASSERT_TRUE(find_builtin_scene(default_scene_name));
  EXPECT_EQ(find_builtin_scene("no such scene"), nullptr);
}

/// A number over the exponents that every unit's bounds leave.
double positive(Random& random) {
  return std::ldexp(random.uniform(0.5, 1), random.integer(-9, 9));
}
double signed_number(Random& random) {
  return random.integer(0, 9) == 0 ? 0.0 : (random.coin() ? 1 : -1) * positive(random);
}
Vec3 any_vector(Random& random) {
  const double x = signed_number(random), y = signed_number(random), z = signed_number(random);
  return {x, y, z};
}

std::string any_title(Random& random) {
  const std::vector<std::string> pieces{"a", " ",  ",",  ":", "\"", "\\",  "{",
                                        "]", "\n", "\t", "é", "布", "\x7f"};
  std::string title;
  for (int n = random.integer(0, 12); n > 0; --n)
    title += pieces[static_cast<std::size_t>(random.integer(0, static_cast<int>(pieces.size()) - 1))];
  return title;
}

ClothSheet any_sheet(Random& random) {
  ClothSheet sheet;
  sheet.columns = random.integer(2, 4096), sheet.rows = random.integer(2, 4096);
  sheet.width = positive(random), sheet.height = positive(random), sheet.mass = positive(random);
  sheet.origin = any_vector(random);
  sheet.across = random.vector(3), sheet.down = random.vector(3);
  for (int n = random.integer(0, 5); n > 0; --n) {
    if (random.coin())
      sheet.pins.emplace_back(static_cast<NamedPin>(random.integer(0, named_pin_count - 1)));
    else
      sheet.pins.emplace_back(
          PinnedParticle{random.integer(0, sheet.rows - 1), random.integer(0, sheet.columns - 1)});
  }
  return sheet;
}

Obstacle any_obstacle(Random& random) {
  Obstacle obstacle;
  obstacle.shape = obstacle_shapes()[static_cast<std::size_t>(random.integer(0, 2))];
  if (obstacle.shape == &sphere_shape())
    obstacle.center = any_vector(random), obstacle.radius = positive(random);
  if (obstacle.shape == &box_shape())
    obstacle.center = any_vector(random), obstacle.size = {positive(random), 1, 2};
  if (obstacle.shape == &plane_shape())
    obstacle.point = any_vector(random), obstacle.normal = random.vector(1);
  obstacle.response = random.coin() ? "coulomb" : "reflect";
  obstacle.friction = positive(random), obstacle.restitution = random.uniform(0, 1);
  return obstacle;
}

Deformation any_deformation(Random& random) {
  const std::vector<Words> sets{{}, {"structural"}, {"structural", "shear"}};
  Deformation deformation;
  deformation.rate = random.uniform(0, 1), deformation.tolerance = positive(random);
  deformation.springs = sets[static_cast<std::size_t>(random.integer(0, 2))];
  deformation.max_sweeps = random.integer(1, 1000000);
  deformation.solver = random.coin() ? "direct" : "sweeps";
  return deformation;
}

Scene any_scene(Random& random) {
  Scene scene;
  scene.title = any_title(random);
  scene.cloth = any_sheet(random);
  if (random.coin())
    scene.springs =
        SpringMaterial{positive(random), positive(random), positive(random), random.uniform(0, 1)};
  if (random.coin()) scene.damping = random.coin() ? 0.0 : positive(random);
  if (random.coin()) scene.gravity = any_vector(random);
  if (random.coin()) scene.air = Air{positive(random), positive(random), any_vector(random), std::nullopt};
  if (scene.air && random.coin()) scene.air->gust = Gust{positive(random), positive(random)};
  if (random.coin()) scene.deformation = any_deformation(random);
  for (int n = random.integer(0, 3); n > 0; --n) scene.obstacles.push_back(any_obstacle(random));
  scene.integrator.method = integrator_names()[static_cast<std::size_t>(
      random.integer(0, static_cast<int>(integrator_names().size()) - 1))];
  if (random.coin()) scene.integrator.time_step = positive(random);
  scene.duration = positive(random);
  scene.record.interval = positive(random);
  return scene;
}

TEST(RandomScenes, ReadBackAfterWriting) {
  Random random;
  int read = 0;
  for (int trial = 0; trial < 1000 && !::testing::Test::HasFailure(); ++trial) {
    Scene scene = any_scene(random);
    if (!scene.obstacles.empty()) {  // the start is looked at particle by particle
      scene.cloth.columns = std::min(scene.cloth.columns, 16),
      scene.cloth.rows = std::min(scene.cloth.rows, 16);
      scene.cloth.pins.clear();
      if (!find_start_problems(scene).empty()) continue;
    }
    expect_reads_back(scene);
    ++read;
  }
  EXPECT_GT(read, 300);
}

TEST(SceneHash, TellsScenesApartAndIsTheSameForEqualOnes) {
  Scene scene = builtin_scene("pendulum");
  const std::string hash = scene_hash(scene);
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(scene_hash(builtin_scene("pendulum")), hash);
  scene.cloth.mass = std::nextafter(scene.cloth.mass, 1);
  EXPECT_NE(scene_hash(scene), hash);
}

}  // namespace
}  // namespace cloth::test::scene_round_trip_test
