// The JSON Schema of the format, checked by a validator that knows nothing of Clothlab.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "scene/builtin_scenes.h"
#include "scene/scene_json.h"

namespace cloth::test {
namespace {

class SceneSchema : public ::testing::Test {
 protected:
  SceneSchema() {
    const auto document = nlohmann::json::parse(scene_schema());
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

}  // namespace
}  // namespace cloth::test
