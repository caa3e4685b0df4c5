// The JSON Schema of plans, checked by a validator that knows nothing of Clothlab.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "sweep/sweep_plan.h"

namespace cloth::test::sweep_schema_test {
namespace {

bool accepts(const std::string& text) {
  const auto document = nlohmann::json::parse(sweep_schema());
  valijson::Schema schema;
  valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
  const auto instance = nlohmann::json::parse(text);
  valijson::Validator validator;
  return validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(instance), nullptr);
}

const std::string outputs = R"("outputs": [{"of": "max_strain"}])";

TEST(SweepSchema, AcceptsWhatTheReaderAcceptsAndWhatIsWritten) {
  for (const char* members :
       {R"("vary": [{"path": "damping", "values": [1, 2]}])",
        R"("vary": [{"paths": ["springs.shear", "damping"], "values": [[1, 2], [3, 4]]}])",
        R"("vary": [{"path": "damping", "from": 1, "to": 2, "count": 3, "scale": "log"}], "seed": 3)",
        R"("vary": [{"paths": ["springs.shear", "damping"], "from": [1, 2], "to": [3, 4], "count": 2}],
              "limits": {"steps": 10, "wall_s": 0.5}, "set": {"duration": 1}, "title": "a", "design": "grid")"}) {
    const std::string text = R"({"scene": "corners-free", )" + outputs + ", " + members + "}";
    EXPECT_TRUE(accepts(text)) << text;
    const SweepReading reading = read_sweep(text, "a");
    ASSERT_TRUE(reading.plan) << text;
    EXPECT_TRUE(accepts(write_sweep(*reading.plan))) << text;
  }
}

TEST(SweepSchema, RefusesWhatTheReaderRefuses) {
  for (const char* members :
       {R"("vary": [])", R"("vary": [{"path": "damping"}])", R"("vary": [{"values": [1]}])",
        R"("vary": [{"path": "damping", "values": [1], "from": 1, "to": 2}])",
        R"("vary": [{"path": "damping", "paths": ["damping"], "values": [1]}])",
        R"("vary": [{"path": "damping", "values": [1]}], "design": "spiral")",
        R"("vary": [{"path": "damping", "values": [1]}], "seed": -1)",
        R"("vary": [{"path": "damping", "values": [1]}], "limits": {"wall_s": 0}, "sed": 1)"}) {
    const std::string text = R"({"scene": "corners-free", )" + outputs + ", " + members + "}";
    EXPECT_FALSE(accepts(text)) << text;
    EXPECT_FALSE(read_sweep(text, "a").plan) << text;
  }
  EXPECT_FALSE(accepts(R"({"scene": "corners-free", "vary": [{"path": "damping", "values": [1]}]})"));
}

}  // namespace
}  // namespace cloth::test::sweep_schema_test
