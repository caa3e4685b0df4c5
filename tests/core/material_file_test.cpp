// Materials as files: the built-in presets, files of one's own, and scenes that name either.
#include "scene/material_file.h"

#include <gtest/gtest.h>

#include "io/text_file.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "support/files.h"
#include "support/materials.h"

namespace cloth::test::material_file_test {
namespace {

constexpr const char* sheet = R"("cloth": {"rows": 5, "columns": 5})";

std::string scene_of(const std::string& material) {
  return std::string("{") + sheet + R"(, "material": )" + material + "}";
}

SceneReading read(const std::string& material, const std::vector<Override>& overrides = {}) {
  return read_scene(scene_of(material), "x.scene.json", overrides);
}

std::string problems_of(const SceneReading& reading) {
  std::string text;
  for (const Problem& problem : reading.problems) text += problem.text() + "\n";
  return text;
}

Material material_of(const SceneReading& reading) {
  EXPECT_TRUE(reading.scene) << problems_of(reading);
  return reading.scene ? reading.scene->material.value_or(Material{}) : Material{};
}

TEST(Presets, AreTheFabricsOfTheSourcesEachWithWhatWasMeasuredAndWhatWasAssumed) {
  int of_wang = 0, of_matsudaira = 0;
  for (const BuiltinMaterial& one : builtin_materials()) {
    const MaterialFile file = builtin_material(one.name);
    EXPECT_EQ(file.title, one.title);
    EXPECT_FALSE(file.source.assumed.empty()) << one.name;
    EXPECT_EQ(file.source.author.empty(), file.source.measured.empty()) << one.name;
    of_wang += file.source.text() == "Wang, O'Brien, Ramamoorthi 2011";
    of_matsudaira += file.source.text() == "Matsudaira et al. 2015";
  }
  EXPECT_EQ(of_wang, 10);
  EXPECT_EQ(of_matsudaira, 3);
}

TEST(Presets, FitSquareSpringsAllButOne) {
  for (const BuiltinMaterial& one : builtin_materials()) {
    const Scene scene = material_sheet(5, 5, 0.01, 0.01, builtin_material(one.name).material);
    const auto problems = find_problems(scene);
    if (one.name != "navy-sparkle-sweat") {
      EXPECT_TRUE(problems.empty()) << one.name << ' ' << problems[0].text();
    } else {
      ASSERT_EQ(problems.size(), 1u);
      EXPECT_NE(problems[0].rule.find("must be at most 6.5 N/m"), std::string::npos) << problems[0].rule;
    }
  }
}

TEST(Presets, OfThreeMeasuredDirectionsBendAsMeasuredAtFortyFiveDegrees) {
  constexpr double pi = 3.14159265358979;
  EXPECT_NEAR(bending_at(builtin_material("gray-interlock").material, pi / 4), 24.7e-6, 1e-18);
  EXPECT_NEAR(bending_at(builtin_material("royal-target").material, pi / 4), 108e-6, 1e-18);
}

TEST(Presets, StandInASceneByTheirNameAndWhatIsGivenReplacesTheirValues) {
  const Material gray = builtin_material("gray-interlock").material;
  EXPECT_EQ(material_of(read(R"("gray-interlock")")), gray);
  EXPECT_EQ(material_of(read(R"({"preset": "gray-interlock"})")), gray);
  Material changed = gray;
  changed.shear = 25;
  EXPECT_EQ(material_of(read(R"({"preset": "gray-interlock", "shear": 25})")), changed);
  changed = gray;
  changed.twist = twist_from(gray.bending_warp, gray.bending_weft, 3e-5);
  EXPECT_EQ(material_of(read(R"({"preset": "gray-interlock", "bending_45": 3e-5})")), changed);
}

TEST(Presets, OfAWrittenSceneAreWrittenOutSoThatItIsWhole) {
  const Scene scene = *read(R"("gray-interlock")").scene;
  const std::string text = write_scene(scene);
  EXPECT_EQ(text.find("preset"), std::string::npos);
  EXPECT_EQ(*read_scene(text, "x").scene, scene);
}

TEST(Presets, ThatAreUnknownAreAnsweredWithTheKnownOnes) {
  const std::string text = problems_of(read(R"("gray-interlok")"));
  EXPECT_EQ(text.find("x.scene.json:1:50: material.preset = \"gray-interlok\": must be 11oz-black-denim"), 0u)
      << text;
  EXPECT_NE(text.find("gray-interlock"), std::string::npos);
  EXPECT_EQ(text.find('\n'), text.size() - 1) << "one problem is one message";
  for (const char* bad : {R"({"preset": 3})", R"({"preset": ""})", R"(3)", R"({"presett": "paper"})"})
    EXPECT_FALSE(read(bad).scene) << bad;
}

TEST(Presets, CanBeSetOverAScenesSpringsAndValueByValue) {
  const std::string of_springs = R"({"cloth": {"rows": 5, "columns": 5, "mass": 0.3}, "damping": 0.1,
    "springs": {"structural": 500}, "air": {"drag": 0.1, "skin_friction": 0.1, "wind": [1, 0, 0]}})";
  const SceneReading set = read_scene(of_springs, "x", {{"material", "paper"}, {"material.shear", "5"}});
  Material paper = builtin_material("paper").material;
  paper.shear = 5;
  EXPECT_EQ(material_of(set), paper);
  EXPECT_FALSE(set.scene->springs || set.scene->damping);
  EXPECT_EQ(set.scene->air->wind.x(), 1);
  EXPECT_EQ(material_of(read(R"("gray-interlock")", {{"material.shear", "5"}})).shear, 5);
  EXPECT_FALSE(read_scene(of_springs, "x", {{"material", "paper"}, {"springs.shear", "5"}}).scene);
}

TEST(MaterialFiles, AreReadFromTheScenesFolder) {
  const TemporaryFolder folder;
  MaterialFile mine{"Mine", {"Me", 2026, "All of it.", ""}, any_material()};
  mine.material.shear = 1.0 / 3;
  write_text_file(folder / "mine.material.json", write_material_file(mine));
  const std::string place = (folder / "x.scene.json").string();
  for (const char* name : {R"("./mine.material.json")", R"("mine.material.json")"})
    EXPECT_EQ(material_of(read_scene(scene_of(name), place)), mine.material);
  write_text_file(folder / "bad.material.json", R"({"material": {"areal_density": -1}})");
  EXPECT_NE(
      problems_of(read_scene(scene_of(R"("bad.material.json")"), place))
          .find("cannot be used: bad.material.json:1:32: material.areal_density = -1 kg/m^2: must be > 0"),
      std::string::npos);
  EXPECT_NE(problems_of(read_scene(scene_of(R"("none.material.json")"), place)).find("No such file"),
            std::string::npos);
}

TEST(MaterialFiles, ReadBackToTheSameBits) {
  for (const BuiltinMaterial& one : builtin_materials()) {
    const MaterialFile file = builtin_material(one.name);
    const MaterialFileReading again = read_material_file(write_material_file(file), "x");
    ASSERT_TRUE(again.file) << one.name;
    EXPECT_EQ(*again.file, file) << one.name;
  }
}

TEST(MaterialFiles, AreAnsweredWithAllOfTheirProblems) {
  const MaterialFileReading reading = read_material_file(R"({"format": "clothlab/material/2", "tilte": "",
    "source": {"year": "1999", "who": ""}, "material": {"shear": -3, "twist": "1", "bending_45": -1, "x": 1}})",
                                                         "y");
  EXPECT_FALSE(reading.file);
  std::vector<std::string> paths;
  for (const Problem& problem : reading.problems) paths.push_back(problem.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"format", "tilte", "source.year", "source.who",
                                             "material.areal_density", "material.shear", "material.twist",
                                             "material.bending_45", "material.x"}));
  for (const char* bad : {"", "[]", "{}", "3", R"({"material": 3})", R"({"material": {"areal_density": 0}})",
                          R"({"material": {"areal_density": 1, "preset": "paper"}})"})
    EXPECT_FALSE(read_material_file(bad, "y").file) << bad;
}

}  // namespace
}  // namespace cloth::test::material_file_test
