// Materials on the command line: listed, printed as files, and named by scenes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "io/text_file.h"
#include "scene/material_file.h"
#include "support/files.h"

namespace cloth::test::materials_test {
namespace {

using Json = nlohmann::json;

TEST(Materials, AreListedEachWithItsValuesAndSource) {
  const CommandResult text = cli("materials");
  EXPECT_EQ(text.exit_code, 0) << text.errors;
  const Json list = Json::parse(cli("materials --json").output)["materials"];
  ASSERT_EQ(list.size(), builtin_materials().size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    const BuiltinMaterial& one = builtin_materials()[k];
    EXPECT_NE(text.output.find(one.name), std::string::npos);
    EXPECT_EQ(list[k]["name"], one.name);
    EXPECT_EQ(list[k]["title"], one.title);
    EXPECT_EQ(list[k]["material"]["shear"], builtin_material(one.name).material.shear);
    EXPECT_FALSE(list[k]["source"]["assumed"].empty());
  }
}

TEST(Materials, ArePrintedAsFilesThatAScenesNameReads) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "mine.material.json", cli("materials 11oz-black-denim").output));
  ASSERT_FALSE(write_text_file(folder / "x.scene.json", R"({"cloth": {"rows": 5, "columns": 5},
    "material": {"preset": "./mine.material.json", "shear": 10}, "duration": 0.01})"));
  const std::string out = (folder / "run").string();
  const CommandResult run = cli("run '" + (folder / "x.scene.json").string() + "' --out '" + out + "'");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const Json written = Json::parse(content_of(out + "/scene.json"))["material"];
  EXPECT_EQ(written["stretch_weft"], 2028);
  EXPECT_EQ(written["shear"], 10);
  EXPECT_FALSE(written.contains("preset"));
  EXPECT_EQ(cli("run '" + out + "/scene.json'").exit_code, 0);
}

TEST(Materials, TakeThePlaceOfAScenesSpringsOnTheCommandLine) {
  const Json run =
      Json::parse(cli("run corners-shear --set material=gray-interlock --set duration=0.01 --json").output);
  EXPECT_EQ(run["status"], "finished") << run;
  const CommandResult unknown = cli("run flag --set material=grey-interlock");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(unknown.errors.find("--set: material.preset = \"grey-interlock\": must be 11oz-black-denim"), 0U)
      << unknown.errors;
  EXPECT_EQ(cli("materials grey-interlock").exit_code, 2);
}

TEST(Materials, OfAScenesSpringsArePrintedAndTurnIntoSpringsAgain) {
  const TemporaryFolder folder;
  const CommandResult of = cli("materials --of corners-free");
  ASSERT_EQ(of.exit_code, 0) << of.errors;
  EXPECT_NE(of.errors.find("cube of the curvature"), std::string::npos) << of.errors;
  EXPECT_TRUE(read_material_file(of.output, "x").file);
  ASSERT_FALSE(write_text_file(folder / "x.material.json", of.output));
  ASSERT_FALSE(write_text_file(folder / "x.scene.json", R"({"cloth": {}, "material": "./x.material.json"})"));
  const CommandResult back = cli("materials --springs-of '" + (folder / "x.scene.json").string() + "'");
  ASSERT_EQ(back.exit_code, 0) << back.errors;
  const Json springs = Json::parse(back.output)["springs"],
             first = Json::parse(cli("scenes corners-free").output)["springs"];
  EXPECT_NEAR(springs["shear"].get<double>(), first["shear"].get<double>(), 1e-9);
  EXPECT_NEAR(springs["structural"].get<double>(),
              first["structural"].get<double>() + 4 * first["flexion"].get<double>(), 1e-9);
  EXPECT_EQ(cli("materials --of disc").exit_code, 2);
  EXPECT_EQ(cli("materials --springs-of flag").errors, "clothlab-cli: flag: The scene has no material.\n");
  EXPECT_EQ(cli("materials paper --of flag").exit_code, 2);
}

}  // namespace
}  // namespace cloth::test::materials_test
