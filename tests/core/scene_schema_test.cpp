// The JSON Schemas of the formats, checked by a validator that knows nothing of Clothlab.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "compare/builtin_comparisons.h"
#include "compare/comparison_json.h"
#include "scene/builtin_scenes.h"
#include "scene/material_file.h"
#include "scene/scene_json.h"

namespace cloth::test::scene_schema_test {
namespace {

class SchemaTest : public ::testing::Test {
 protected:
  explicit SchemaTest(const std::string& schema) {
    const auto document = nlohmann::json::parse(schema);
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema_);
  }

  bool accepts(const std::string& text) const {
    const auto document = nlohmann::json::parse(text);
    valijson::Validator validator;
    return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), nullptr);
  }

 private:
  valijson::Schema schema_;
};

class SceneSchema : public SchemaTest {
 protected:
  SceneSchema() : SchemaTest(scene_schema()) {}
};

class MaterialSchema : public SchemaTest {
 protected:
  MaterialSchema() : SchemaTest(material_schema()) {}
};

class ComparisonSchema : public SchemaTest {
 protected:
  ComparisonSchema() : SchemaTest(comparison_schema()) {}
};

TEST_F(SceneSchema, AcceptsEveryBuiltinScene) {
  for (const BuiltinScene& builtin : builtin_scenes()) EXPECT_TRUE(accepts(builtin.text)) << builtin.name;
}

TEST_F(SceneSchema, AcceptsWhatIsWritten) {
  for (const BuiltinScene& builtin : builtin_scenes())
    EXPECT_TRUE(accepts(write_scene(builtin_scene(builtin.name)))) << builtin.name;
}

TEST_F(SceneSchema, AcceptsTheSmallestScene) {
  EXPECT_TRUE(accepts("{\"cloth\": {}}"));
}

TEST_F(SceneSchema, AcceptsMaterialsByNameByFileAndInFull) {
  for (const char* material :
       {R"("paper")", R"("./mine.material.json")", R"({"preset": "paper", "shear": 3})",
        R"({"areal_density": 0.1, "bending_45": 1e-5})", R"({"areal_density": 0.1, "twist": 1e-5})"})
    EXPECT_TRUE(accepts(std::string(R"({"cloth": {}, "material": )") + material + "}")) << material;
  for (const char* material :
       {R"("papr")", R"({"preset": 3})", R"({"bending_45": 1, "twist": 1})", R"({"areal_density": -1})"})
    EXPECT_FALSE(accepts(std::string(R"({"cloth": {}, "material": )") + material + "}")) << material;
}

TEST_F(MaterialSchema, AcceptsTheBuiltInMaterialsAndWhatIsWritten) {
  for (const BuiltinMaterial& one : builtin_materials()) {
    EXPECT_TRUE(accepts(one.text)) << one.name;
    EXPECT_TRUE(accepts(write_material_file(builtin_material(one.name)))) << one.name;
  }
  for (const char* text : {"{}", R"({"material": {}})", R"({"material": {"areal_density": 1, "x": 1}})",
                           R"({"material": {"areal_density": 1}, "source": {"year": "1"}})"})
    EXPECT_FALSE(accepts(text)) << text;
}

TEST_F(SceneSchema, RefusesWhatTheReaderRefuses) {
  for (const char* text : {R"({})",
                           R"([])",
                           R"({"cloth": {}, "sprigns": {}})",
                           R"({"cloth": {"columns": 1}})",
                           R"({"cloth": {"mass": -1}})",
                           R"({"cloth": {"mass": 0}})",
                           R"({"cloth": {"widht": 1}})",
                           R"({"cloth": {"pins": ["middle"]}})",
                           R"({"cloth": {"pins": [[0, -1]]}})",
                           R"({"cloth": {"pins": [[0]]}})",
                           R"({"cloth": {"mesh": "disc.obj", "columns": 3}})",
                           R"({"cloth": {"mesh": "disc.obj", "pins": ["top-left"]}})",
                           R"({"cloth": {}, "obstacles": [{"shape": "mesh"}]})",
                           R"({"cloth": {}, "springs": {"shear": "5"}})",
                           R"({"cloth": {}, "springs": {"shear": -5}})",
                           R"({"cloth": {}, "gravity": [0, 1]})",
                           R"({"cloth": {}, "air": {"gust": {"frequency": -1}}})",
                           R"({"cloth": {}, "deformation": {"springs": ["flexion"]}})",
                           R"({"cloth": {}, "obstacles": [{"shape": "torus"}]})",
                           R"({"cloth": {}, "obstacles": [{"radius": 1}]})",
                           R"({"cloth": {}, "obstacles": [{"shape": "sphere", "size": [1, 1, 1]}]})",
                           R"({"cloth": {}, "integrator": {"method": "euler"}})",
                           R"({"cloth": {}, "integrator": {"time_step": "quick"}})",
                           R"({"cloth": {}, "integrator": {"time_step": 0}})",
                           R"({"cloth": {}, "format": "clothlab/scene/9"})",
                           R"({"cloth": {}, "duration": 0})"}) {
    EXPECT_FALSE(accepts(text)) << text;
    EXPECT_FALSE(read_scene(text, "name").scene) << text;
  }
}

TEST_F(ComparisonSchema, AcceptsWhatIsBuiltInAndWhatIsWritten) {
  for (const BuiltinComparison& builtin : builtin_comparisons()) {
    EXPECT_TRUE(accepts(builtin.text)) << builtin.name;
    EXPECT_TRUE(accepts(write_comparison(builtin_comparison(builtin.name)))) << builtin.name;
  }
  EXPECT_TRUE(accepts(R"({"scene": "ball", "panes": [{}, {"own": {"obstacles.0.radius": 0.2}}]})"));
  EXPECT_TRUE(accepts(R"({"scene": "ball", "panes": [{}, {"own": {"integrator.time_step": "auto"}}]})"));
}

TEST_F(ComparisonSchema, RefusesWhatTheReaderRefuses) {
  for (const char* text :
       {R"({"panes": [{}, {}]})", R"({"scene": "flag"})", R"({"scene": "flagg", "panes": [{}, {}]})",
        R"({"scene": {"cloth": {"rows": 1}}, "panes": [{}, {}]})", R"({"scene": "flag", "panes": [{}]})",
        R"({"scene": "flag", "panes": [{}, {}, {}, {}, {}]})",
        R"({"scene": "flag", "panes": [{}, {"name": "E"}]})",
        R"({"scene": "flag", "panes": [{}, {"own": {"springs.shear": -1}}]})",
        R"({"scene": "flag", "panes": [{}, {"own": {"springs.strength": 1}}]})",
        R"({"scene": "flag", "panes": [{}, {"own": {"cloth.rows": 5}}]})",
        R"({"scene": "flag", "panes": [{}, {"own": {"air": null}}]})",
        R"({"scene": "flag", "panes": [{}, {}], "reference": "E"})",
        R"({"scene": "flag", "panes": [{}, {}], "format": "clothlab/scene/1"})"}) {
    EXPECT_FALSE(accepts(text)) << text;
    EXPECT_FALSE(read_comparison(text, "name").comparison) << text;
  }
}

}  // namespace
}  // namespace cloth::test::scene_schema_test
