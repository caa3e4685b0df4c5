#include "scene/scene_edits.h"

#include <gtest/gtest.h>

#include <map>

#include "scene/builtin_scenes.h"
#include "io/json_locator.h"
#include "scene/scene_json.h"

namespace cloth::test::scene_edits_test {
namespace {

using Edits = std::map<std::string, std::string>;

Edits edits(const Scene& before, const Scene& after) {
  Edits found;
  for (const SceneEdit& edit : edits_between(before, after)) found[edit.path] = edit.value;
  return found;
}

TEST(SceneEdits, OfAnUnchangedSceneAreNone) {
  for (const BuiltinScene& builtin : builtin_scenes())
    EXPECT_TRUE(edits(builtin_scene(builtin.name), builtin_scene(builtin.name)).empty());
}

TEST(SceneEdits, NameTheParametersThatChanged) {
  const Scene before = builtin_scene("ball");
  Scene after = before;
  after.springs->shear = 77;
  after.obstacles[1].friction = 0.25;
  after.integrator.time_step = 0.0005;
  EXPECT_EQ(edits(before, after), (Edits{{"springs.shear", "77.0"},
                                         {"obstacles.1.friction", "0.25"},
                                         {"integrator.time_step", "0.0005"}}));
}

TEST(SceneEdits, NameBlocksThatCameAndWentAndPins) {
  const Scene before = builtin_scene("ball");
  Scene after = before;
  after.air.reset();
  after.damping = 0.5;
  after.cloth.pins = {NamedPin::top_left};
  EXPECT_EQ(edits(before, after),
            (Edits{{"air", "null"}, {"damping", "0.5"}, {"cloth.pins", "[\"top-left\"]"}}));
}

TEST(SceneEdits, SetAgainLeadToTheSameScene) {
  const Scene before = builtin_scene("ball");
  Scene after = before;
  after.springs->shear = 1.0 / 3;
  after.gravity = Vec3(0.1, -9.7, 1e-17);
  after.air->gust.emplace();
  after.deformation->springs = {"structural"};
  std::vector<Override> overrides;
  for (const SceneEdit& edit : edits_between(before, after)) overrides.push_back({edit.path, edit.value});
  const SceneReading reading = read_scene(write_scene(before), "name", overrides);
  ASSERT_TRUE(reading.scene) << reading.problems.front().text();
  EXPECT_EQ(*reading.scene, after);
}

TEST(JsonLocator, FindsValuesKeysAndRepeats) {
  const JsonLocations found = locate_json("{ \"a\": [1, {\"b\": \"x\\\"]\"}],\n  \"c\": 2, \"c\": 3 }");
  const auto at = [](const TextPosition& p) { return std::pair(p.line, p.column); };
  EXPECT_EQ(at(found.values.at("")), std::pair(1, 1));
  EXPECT_EQ(at(found.values.at("a")), std::pair(1, 8));
  EXPECT_EQ(at(found.values.at("a.0")), std::pair(1, 9));
  EXPECT_EQ(at(found.values.at("a.1.b")), std::pair(1, 18));
  EXPECT_EQ(at(found.keys.at("a.1.b")), std::pair(1, 13));
  EXPECT_EQ(at(found.values.at("c")), std::pair(2, 16));
  EXPECT_EQ(found.repeated, std::vector<std::string>{"c"});
}

}  // namespace
}  // namespace cloth::test::scene_edits_test
