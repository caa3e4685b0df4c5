// clothlab-cli identify: values that a run was made with come back, its files, its answers to bad usage, its
// exit codes.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command_line.h"
#include "io/csv.h"
#include "support/files.h"

namespace cloth::test::identify_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string small =
    " corners-free --set duration=0.2 --set cloth.rows=9 --set cloth.columns=9 --set record.interval=0.01 ";

/// The table that a run with these settings leaves.
CsvTable record_of(const TemporaryFolder& folder, const std::string& settings) {
  const std::string out = (folder / "made").string();
  EXPECT_EQ(cli("run" + small + settings + " --out '" + out + "'").exit_code, 0);
  return parse_csv(content_of(out + "/record.csv"));
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string text_of(double value) {
  return csv_number(value);
}

TEST(Identify, GivesAStiffnessBackFromOneValueOfARun) {
  const TemporaryFolder folder;
  const CsvTable record = record_of(folder, "--set springs.structural=150");
  const std::vector<double> strain = column_of(record, "max_strain");
  const double largest = *std::max_element(strain.begin(), strain.end());
  const CommandResult result = cli("identify" + small +
                                   "--set springs.structural=100 --vary springs.structural:50:400 "
                                   "--target max_strain:max=" +
                                   text_of(largest) + " --json");
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["status"], "converged");
  EXPECT_EQ(json["identified"], true);
  EXPECT_NEAR(json["parameters"][0]["value"].get<double>(), 150, 0.5);
  EXPECT_EQ(json["parameters"][0]["verdict"], "identified");
  EXPECT_NEAR(json["targets"][0]["simulated"].get<double>(), largest, 1e-4 * largest);
}

TEST(Identify, FitsACurveAndPredictsWhatIsHeldOut) {
  const TemporaryFolder folder;
  const CsvTable record = record_of(folder, "--set springs.structural=150");
  const std::vector<double> times = column_of(record, "time_s"), elastic = column_of(record, "elastic_J"),
                            kinetic = column_of(record, "kinetic_J");
  std::string csv = "time_s,elastic_J,elastic_J_sigma\n";
  for (std::size_t k = 1; k < times.size(); k += 2)
    csv += text_of(times[k]) + "," + text_of(elastic[k] * (k % 4 == 1 ? 1.01 : 0.99)) + "," +
           text_of(0.02 * elastic[k]) + "\n";
  write_text(folder / "measured.csv", csv);
  const std::string out = (folder / "fit").string();
  const CommandResult result =
      cli("identify" + small + "--vary springs.structural:50:400 --measured '" +
          (folder / "measured.csv").string() + "' --held-out kinetic_J=" + text_of(kinetic.back()) +
          "±0.001 --starts 4 --descents 1 --out '" + out + "'");
  ASSERT_EQ(result.exit_code, 0) << result.output << result.errors;
  EXPECT_TRUE(has(result.output, "held out")) << result.output;
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(out)) files.insert(entry.path().filename());
  EXPECT_EQ(files,
            (std::set<std::string>{"identified.json", "parameters.csv", "targets.csv", "fitted.scene.json",
                                   "fit-elastic_J.svg", "report.html", "runs.jsonl"}));
  const auto json = nlohmann::json::parse(content_of(out + "/identified.json"));
  EXPECT_NEAR(json["parameters"][0]["value"].get<double>(), 150, 5);
  EXPECT_EQ(json["files"].size(), 6u);
  EXPECT_EQ(cli("run '" + out + "/fitted.scene.json' --out '" + (folder / "again").string() + "'").exit_code,
            0);
  const CsvTable again = parse_csv(content_of(folder / "again/record.csv"));
  const CsvTable targets = parse_csv(content_of(out + "/targets.csv"));
  EXPECT_NEAR(column_of(again, "kinetic_J").back(), column_of(targets, "simulated").front(), 1e-9);
  EXPECT_TRUE(has(content_of(out + "/report.html"), "The data identify springs.structural."));
}

TEST(Identify, RefusesAPairThatTheValuesCannotTellApart) {
  // One value, two stiffnesses.
  const CommandResult result = cli("identify" + small +
                                   "--vary springs.structural:50:400 --vary springs.shear:1:100 "
                                   "--target lowest_point=0.5±0.001 --starts 2 --descents 1");
  EXPECT_EQ(result.exit_code, 6) << result.output << result.errors;
  EXPECT_TRUE(has(result.output, "The data do not see ")) << result.output;
  EXPECT_TRUE(has(result.output, "unseen")) << result.output;
}

TEST(Identify, HasTheSameBitsHoweverManyRunsGoBesideEachOther) {
  const std::string command =
      "identify" + small +
      "--vary springs.structural:50:400 --target elastic_J:mean=0.01±0.001 --starts 3 "
      "--descents 1 --json --jobs ";
  const CommandResult one = cli(command + "1"), three = cli(command + "3");
  EXPECT_FALSE(one.output.empty()) << one.errors;
  EXPECT_EQ(one.output, three.output);
}

TEST(Identify, GoesOnWithTheRunsOfAFitThatWasKilled) {
  const TemporaryFolder folder;
  const auto command = [&](const std::string& name) {
    return "identify" + small + "--vary springs.structural:50:400 --target elastic_J:mean=0.01±0.001 " +
           "--starts 3 --descents 1 --json --jobs 1 --out '" + (folder / name).string() + "'";
  };
  const CommandResult whole = cli(command("whole"));
  ASSERT_TRUE(whole.exit_code == 0 || whole.exit_code == 6) << whole.errors;
  // What a kill leaves: some whole lines of runs, half a line, and no index.
  const std::string runs = content_of(folder / "whole/runs.jsonl");
  std::size_t cut = 0;
  for (int line = 0; line < 4; ++line) cut = runs.find('\n', cut) + 1;
  ASSERT_GT(std::count(runs.begin(), runs.end(), '\n'), 4);
  std::filesystem::copy(folder / "whole", folder / "cut");
  write_text(folder / "cut/runs.jsonl", runs.substr(0, cut + 10));
  const CommandResult again = cli(command("cut"));
  EXPECT_TRUE(has(again.errors, "3 runs were made before")) << again.errors;
  EXPECT_EQ(again.exit_code, whole.exit_code);
  EXPECT_EQ(again.output, whole.output);
  EXPECT_EQ(content_of(folder / "cut/parameters.csv"), content_of(folder / "whole/parameters.csv"));
  const std::string made = content_of(folder / "cut/runs.jsonl");
  EXPECT_EQ(std::count(made.begin(), made.end(), '\n'), std::count(runs.begin(), runs.end(), '\n'));
  // Another model's runs are of no use.
  const CommandResult other = cli(command("cut") + " --set springs.shear=7");
  EXPECT_FALSE(has(other.errors, "made before")) << other.errors;
}

TEST(Identify, OfBadOptionsExitsWithTwoAndOneMessage) {
  const TemporaryFolder folder;
  write_text(folder / "late.csv", "time_s,elastic_J\n0.1,1\n9,2\n");
  write_text(folder / "other.csv", "time_s,speed\n0.1,1\n");
  write_text(folder / "word.csv", "time_s,elastic_J\n0.1,much\n");
  const std::string out = " --out '" + (folder / "c").string() + "'";
  const std::string late = (folder / "late.csv").string(), other = (folder / "other.csv").string(),
                    word = (folder / "word.csv").string();
  const std::string vary = "--vary springs.structural ", target = "--target elastic_J=1 ";
  const std::pair<std::string, const char*> cases[] = {
      {target, "--vary: name at least one parameter"},
      {vary, "--target: name at least one measured value"},
      {vary + "--held-out elastic_J=1", "--target: name at least one measured value"},
      {"--vary springs.stiffness " + target,
       "--vary: springs.stiffness: is not a parameter that this scene has"},
      {"--vary springs.structural:5 " + target, "must be PATH or PATH:LOW:HIGH"},
      {"--vary springs.structural:5:2 " + target, "its range must go up"},
      {"--vary springs.structural:-5:2 " + target, "must be >= 0"},
      {"--vary 'springs.structural:5 kg:20 kg' " + target, "must be in N/m"},
      {"--vary gravity " + target, "is not a number in this scene"},
      {"--vary cloth.rows:5:20 " + target, "--method derivative-free"},
      {vary + vary + target, "is there twice"},
      {vary + target + target, "is there twice"},
      {vary + "--target speed=1", "--target: speed: must be one of time_s"},
      {vary + "--target elastic_J", "must be SOURCE=VALUE"},
      {vary + "--target elastic_J.median=1", "--target: elastic_J.median: must be one of"},
      {vary + "--target elastic_J=x", "--target: elastic_J: "},
      {vary + "--target elastic_J=1±0", "its standard deviation must be above 0"},
      {vary + target + "--target kinetic_J=1±0.1",
       "give every measured value a standard deviation, or none of them"},
      {vary + "--measured '" + late + "'",
       "late.csv:3:1: time_s = 9 s: must be from 0 to the scene's duration"},
      {vary + "--measured '" + other + "'", "speed: must be one of"},
      {vary + "--measured '" + word + "'", "word.csv:2:2: elastic_J = \"much\": must be a number"},
      {vary + "--measured nowhere.csv", "nowhere.csv"},
      {vary + target + "--method newton", "--method"}};
  for (const auto& [arguments, rule] : cases) {
    const CommandResult result = cli("identify" + small + arguments + out);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    EXPECT_TRUE(has(result.errors, rule)) << arguments << "\n" << result.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "c"));
}

TEST(Identify, OfAModelThatNeverRunsExitsWithThree) {
  const CommandResult result = cli("identify" + small +
                                   "--set integrator.time_step=0.05 --vary springs.structural:50000:100000 "
                                   "--target elastic_J=1 --starts 2");
  EXPECT_EQ(result.exit_code, 3) << result.output << result.errors;
  EXPECT_TRUE(has(result.output, "no value at any of the starts")) << result.output;
}

TEST(Identify, ThatIsInterruptedExitsWith130) {
  const CommandResult result = shell(
      "timeout -s INT 2 \"$CLI\" identify corners-free --set duration=1000 --vary springs.structural "
      "--target "
      "elastic_J=1; echo \"code $?\"");
  EXPECT_TRUE(has(result.output, "code 130") || has(result.output, "code 124"))
      << result.output << result.errors;
  EXPECT_TRUE(has(result.output, "stopped before its end")) << result.output;
}

}  // namespace
}  // namespace cloth::test::identify_test
