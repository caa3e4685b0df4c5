// A parameter is declared once; everything else follows from the declaration.
#include <gtest/gtest.h>

#include <set>

#include "params/doubt.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "scene/scene_parameters.h"
#include "support/files.h"

namespace cloth::test::parameters_test {
namespace {

/// A scene that has every block.
Scene full_scene() {
  Scene scene;
  scene.springs.emplace();
  scene.damping = 0.5;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.air.emplace().gust.emplace();
  scene.deformation.emplace();
  scene.contact.emplace();
  scene.measured.emplace().file = "points.csv";
  // So far apart that no value below lets the cloth start in an obstacle.
  scene.cloth.origin = {-0.5, 20, 30};
  for (const ObstacleShape* one : obstacle_shapes()) {
    Obstacle& obstacle = scene.obstacles.emplace_back();
    obstacle.shape = one;
    one->place(obstacle) = {0, -50, 0};
  }
  scene.obstacles.back().mesh.file = "disc.obj";
  load_meshes(scene);
  return scene;
}

/// A value that the declaration allows and that is not `now`.
ParameterValue another_value(const ParameterInfo& info, const ParameterValue& now) {
  switch (info.kind) {
    case Kind::number:
      return ParameterValue(0.5) == now ? 0.75 : 0.5;
    case Kind::integer:
      return std::get<std::int64_t>(now) + 1;
    case Kind::vector:
      return Vec3(0.25, 0.5, 0.125);
    case Kind::choice:
      return info.choices[info.choices[0] == std::get<std::string>(now) ? 1 : 0];
    case Kind::text:
      return std::string(info.key == "file" ? "cone-bed.obj" : "another");
    case Kind::words:
      return info.word_sets[info.word_sets[0] == std::get<Words>(now) ? 1 : 0];
  }
  return 0.0;
}

std::string as_json(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return std::to_string(*number);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* v = std::get_if<Vec3>(&value))
    return "[" + std::to_string(v->x()) + "," + std::to_string(v->y()) + "," + std::to_string(v->z()) + "]";
  std::string list;
  for (const std::string& word : std::get<Words>(value)) list += (list.empty() ? "\"" : ", \"") + word + "\"";
  return "[" + list + "]";
}

TEST(EveryParameter, CanBeSetByItsPathAndReadBack) {
  const Scene scene = full_scene();
  const std::string text = write_scene(scene);
  for (const Parameter& parameter : parameters_of(scene)) {
    const ParameterValue wanted = another_value(parameter.info, parameter.get(scene));
    const SceneReading reading = read_scene(text, "name", {{parameter.path, as_json(wanted)}});
    ASSERT_TRUE(reading.scene) << parameter.path << ": " << reading.problems.front().text();
    EXPECT_TRUE(parameter.get(*reading.scene) == wanted) << parameter.path;

    Scene set = scene;
    parameter.set(set, wanted);
    load_meshes(set);
    EXPECT_EQ(set, *reading.scene) << parameter.path;
  }
}

TEST(EveryParameter, HasLabelMeaningAndASliderInsideItsRange) {
  for (const Parameter& parameter : parameters_of(full_scene())) {
    const ParameterInfo& info = parameter.info;
    EXPECT_FALSE(info.label.empty()) << parameter.path;
    EXPECT_FALSE(info.doc.empty()) << parameter.path;
    if (info.kind != Kind::number && info.kind != Kind::integer) continue;
    EXPECT_LT(info.slider_minimum, info.slider_maximum) << parameter.path;
    EXPECT_GE(info.slider_minimum, info.minimum) << parameter.path;
    EXPECT_LE(info.slider_maximum, info.maximum) << parameter.path;
  }
}

TEST(EveryParameter, HasAPathOfItsOwnThatFindsIt) {
  const Scene scene = full_scene();
  std::set<std::string> paths;
  for (const Parameter& parameter : parameters_of(scene)) {
    EXPECT_TRUE(paths.insert(parameter.path).second) << parameter.path;
    ASSERT_TRUE(find_parameter(scene, parameter.path));
    EXPECT_TRUE(find_parameter(scene, parameter.path)->get(scene) == parameter.get(scene));
  }
  EXPECT_FALSE(find_parameter(scene, "springs.bend"));
  EXPECT_FALSE(find_parameter(scene, ""));
}

TEST(EveryParameter, HasADefaultThatKeepsItsOwnRule) {
  const Scene scene = full_scene();
  for (const Parameter& parameter : parameters_of(scene)) {
    const auto value = default_of(scene, parameter.path);
    ASSERT_TRUE(value) << parameter.path;
    EXPECT_EQ(broken_rule(parameter.info, *value), std::nullopt) << parameter.path;
  }
}

TEST(EveryParameter, HasPhysicalBoundsThatAreToldAndKept) {
  const Scene scene = full_scene();
  for (const Parameter& parameter : parameters_of(scene)) {
    const ParameterInfo& info = parameter.info;
    if (info.kind != Kind::number && info.kind != Kind::integer && info.kind != Kind::vector) continue;
    const double most = std::min(info.maximum, info.largest);
    EXPECT_LE(most, 1e15) << parameter.path;
    EXPECT_GE(std::max(info.minimum, -info.largest), -1e15) << parameter.path;
    EXPECT_NE(range_text(info).find("<= "), std::string::npos) << parameter.path << range_text(info);
    const auto broken = [&](double value) {
      if (info.kind == Kind::vector) return broken_rule(info, Vec3(1, value, 1)).has_value();
      return broken_rule(info, value).has_value();
    };
    EXPECT_FALSE(broken(most)) << parameter.path;
    for (const double value : {most * 1.01, 1e16, 1e308, -1e16, -1e308})
      EXPECT_TRUE(broken(value)) << parameter.path << " = " << value;
  }
  EXPECT_EQ(*broken_rule(find_parameter(scene, "cloth.width")->info, 0.0), "must be > 0");
  EXPECT_EQ(*broken_rule(find_parameter(scene, "cloth.width")->info, 1e-300), "must be >= 1e-09");
  EXPECT_EQ(*broken_rule(find_parameter(scene, "duration")->info, 1e20),
            "must be <= 1e+09, or sums and numbers of steps could overflow");
}

TEST(Offers, AddWhatTheSceneLacksAndRemovalTakesItOutAgain) {
  Scene scene;
  std::set<std::string> offered;
  for (const BlockOffer& offer : offers_for(scene)) {
    offered.insert(offer.path);
    Scene with = scene;
    offer.add(with);
    EXPECT_NE(with, scene) << offer.path;
    EXPECT_TRUE(find_problems(with).empty()) << offer.path;
    const bool obstacle = with.obstacles.size() > scene.obstacles.size();
    const bool probe = with.probes.size() > scene.probes.size();
    remove_block(with, obstacle ? "obstacles.0" : probe ? "probes.0" : offer.path);
    EXPECT_EQ(with, scene) << offer.path;
  }
  EXPECT_EQ(offered, std::set<std::string>({"springs", "material", "deformation", "damping", "gravity", "air",
                                            "self_contact", "measured", "sphere", "box", "plane", "mesh",
                                            "lowest-point", "extent", "shadow", "drape", "droop", "rest"}));
  for (const BlockOffer& offer : offers_for(full_scene()))
    EXPECT_TRUE(offer.path == "self_contact" || offer.group != BlockOffer::Group::block) << offer.path;
}

TEST(RemovingABlock, ThatIsNotThereChangesNothing) {
  Scene scene = full_scene();
  for (const char* path : {"obstacles.4", "obstacles.x", "obstacles.", "cloth", "nothing", ""}) {
    remove_block(scene, path);
    EXPECT_EQ(scene, full_scene()) << path;
  }
}

TEST(Blocks, AreOnlyThoseThatTheSceneHas) {
  std::vector<std::string> paths;
  for (const Block& block : blocks_of(builtin_scene("free-fall"))) paths.push_back(block.path);
  EXPECT_EQ(paths, std::vector<std::string>({"integrator", "springs", "gravity", "cloth", "run"}));
}

TEST(ReferencePage, IsTheOneInDocs) {
  EXPECT_EQ(content_of(std::string(CLOTHLAB_SOURCE_DIR) + "/docs/parameters.md"), reference_page())
      << "make it again: clothlab-cli parameters > docs/parameters.md";
}

TEST(ReferencePage, NamesEveryParameter) {
  const std::string page = reference_page();
  Scene of_springs = full_scene(), of_material;
  of_springs.obstacles.clear();
  of_material.material.emplace();
  add_every_block(of_material);
  for (const Scene& scene : {of_springs, of_material})
    for (const Parameter& parameter : parameters_of(scene))
      EXPECT_NE(page.find("`" + parameter.path + "`"), std::string::npos) << parameter.path;
}

TEST(Parameters, BeyondAllSenseHaveAReasonAndSensibleOnesHaveNone) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin_scene(builtin.name);
    for (const Parameter& parameter : parameters_of(scene)) {
      EXPECT_FALSE(doubt_about(parameter.info, parameter.get(scene)))
          << builtin.name << ' ' << parameter.path;
      if (parameter.info.kind == Kind::number) {
        EXPECT_FALSE(doubt_about(parameter.info, parameter.info.slider_maximum)) << parameter.path;
      }
    }
  }
  const Scene scene = full_scene();
  EXPECT_TRUE(doubt_about(find_parameter(scene, "integrator.time_step")->info, 100.0));
  EXPECT_TRUE(doubt_about(find_parameter(scene, "springs.structural")->info, 1e12));
  EXPECT_TRUE(doubt_about(find_parameter(scene, "gravity")->info, Vec3(0, -1e5, 0)));
}

}  // namespace
}  // namespace cloth::test::parameters_test
