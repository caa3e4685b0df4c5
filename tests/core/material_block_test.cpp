// The block "material" of a scene file: what it replaces, needs and refuses.
#include <gtest/gtest.h>

#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "support/materials.h"

namespace cloth::test::material_block_test {
namespace {

std::vector<std::string> problems_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const SceneReading reading = read_scene(text, "name", overrides);
  std::vector<std::string> texts;
  for (const Problem& problem : reading.problems) texts.push_back(problem.text());
  return texts;
}

using Texts = std::vector<std::string>;

TEST(MaterialBlock, RefusesWhatItReplacesAndNamesBoth) {
  EXPECT_EQ(
      problems_of("{ \"cloth\": { \"mass\": 1 },\n"
                  "\"material\": { \"areal_density\": 0.1 },\n"
                  "\"springs\": { \"structural\": 3 },\n"
                  "\"damping\": 0.1,\n"
                  "\"air\": { \"wind\": [1, 0, 0], \"drag\": 2, \"skin_friction\": 3 } }"),
      Texts({"name:1:22: cloth.mass = 1: must be left out beside \"material\", which has "
             "material.areal_density for it",
             "name:3:1: springs: must be left out beside \"material\", which has stretch_warp, stretch_weft, "
             "shear and bending for it",
             "name:4:12: damping = 0.1: must be left out beside \"material\", which has "
             "material.mass_damping for it",
             "name:5:37: air.drag = 2: must be left out beside \"material\", which has material.drag_normal "
             "for it",
             "name:5:57: air.skin_friction = 3: must be left out beside \"material\", which has "
             "material.drag_tangential for it"}));
}

TEST(MaterialBlock, NeedsAnArealDensityAndLeavesOutWhatIsNotGiven) {
  EXPECT_EQ(problems_of("{ \"cloth\": {}, \"material\": {} }"),
            Texts({"name:1:28: material.areal_density = 0 kg/m^2: must be > 0"}));
  const SceneReading reading =
      read_scene("{ \"cloth\": {}, \"material\": { \"areal_density\": 0.1 } }", "name");
  ASSERT_TRUE(reading.scene);
  Material bare;
  bare.areal_density = 0.1;
  EXPECT_EQ(*reading.scene->material, bare);
  const ClothSystem system = make_cloth(*reading.scene);
  EXPECT_TRUE(system.bending.empty());
  EXPECT_TRUE(system.springs.empty());
}

TEST(MaterialBlock, SaysWhichShearFitsSpringsOnTheseCells) {
  const std::string text =
      "{ \"cloth\": { \"columns\": 11, \"rows\": 11, \"width\": 1, \"height\": 0.5 },\n"
      "\"material\": { \"areal_density\": 0.1, \"stretch_warp\": 100, \"stretch_weft\": 80, \"shear\": 21 } "
      "}";
  const Texts found = problems_of(text);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].substr(0, 55), "name:2:87: material.shear = 21 N/m: must be at most 20 ") << found[0];
  EXPECT_EQ(problems_of(text, {{"material.shear", "20"}}), Texts{});
  EXPECT_EQ(problems_of(text, {{"cloth.height", "1"}}), Texts{}) << "square cells";
}

TEST(MaterialBlock, IsForRectangularCells) {
  const std::string text =
      "{ \"cloth\": { \"down\": [0.5, -1, 0] }, \"material\": { \"areal_density\": 0.1 } }";
  EXPECT_EQ(problems_of(text),
            Texts({"name:1:22: cloth.down = [0.5, -1, 0]: must be at right angles to cloth.across: the cells "
                   "of a material are rectangles"}));
}

TEST(MaterialBlock, TakesTheBendingAt45DegreesForTheTwist) {
  const auto with = [](const std::string& more) {
    return "{ \"cloth\": {}, \"material\": { \"areal_density\": 0.1, \"bending_warp\": 2e-5, "
           "\"bending_weft\": "
           "4e-5" +
           more + " } }";
  };
  const SceneReading reading = read_scene(with(", \"bending_45\": 2.5e-5"), "name");
  ASSERT_TRUE(reading.scene);
  EXPECT_NEAR(reading.scene->material->twist, 2e-5, 1e-19);
  EXPECT_EQ(problems_of(with(", \"bending_45\": 2.5e-5, \"twist\": 1e-5")).size(), 1u);
  EXPECT_EQ(problems_of(with(", \"bending_45\": -1")).size(), 1u);
  EXPECT_EQ(problems_of(with(", \"bending_45\": \"soft\"")).size(), 1u);
  const Texts negative = problems_of(with(", \"bending_45\": 1e-5"));
  ASSERT_EQ(negative.size(), 1u);
  EXPECT_NE(negative[0].find("must be at least a quarter"), std::string::npos) << negative[0];
}

TEST(MaterialBlock, IsWrittenAndReadBackAndHasNoMassOfItsOwnBesideIt) {
  Scene scene = complete_material_scene();
  const std::string text = write_scene(scene);
  EXPECT_EQ(text.find("\"mass\""), std::string::npos);
  EXPECT_EQ(text.find("\"drag\""), std::string::npos);
  const SceneReading reading = read_scene(text, "name");
  ASSERT_TRUE(reading.scene) << reading.problems.front().text();
  EXPECT_EQ(reading.scene->material, scene.material);
  EXPECT_EQ(write_scene(*reading.scene), text);
}

}  // namespace
}  // namespace cloth::test::material_block_test
