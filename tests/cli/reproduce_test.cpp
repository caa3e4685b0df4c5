#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "support/files.h"

namespace cloth::test::reproduce_test {
namespace {

TEST(ReproduceCommand, LeavesTheReportAndGivesItsNumbersAsJson) {
  const TemporaryFolder folder;
  const CommandResult result =
      cli("reproduce --only errata --json --out '" + (folder / "report").string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["status"], "finished");
  EXPECT_GT(json["numbers"].size(), 20u);
  for (const auto& file : json["files"])
    EXPECT_FALSE(content_of(folder.path() / "report" / file.get<std::string>()).empty()) << file;
}

TEST(ReproduceCommand, RefusesAnUnknownPart) {
  EXPECT_EQ(cli("reproduce --only fig9 --out nowhere").exit_code, 2);
  EXPECT_EQ(cli("reproduce").exit_code, 2);
}

TEST(ReproduceCommand, InterruptedLeavesAWholePage) {
  const TemporaryFolder folder;
  const CommandResult result = shell("\"$CLI\" reproduce --only equal-error --out '" +
                                     (folder / "report").string() + "' & sleep 0.3; kill -TERM $!; wait $!");
  EXPECT_EQ(result.exit_code, 130);
  const std::string page = content_of(folder.path() / "report" / "report.html");
  EXPECT_NE(page.find("Stopped before the end"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::reproduce_test
