// What a merge leaves of sweeps over more than two parameters, of samples and of tables of points.
#include "sweep/sweep_account.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/sensitivity_report.h"
#include "support/files.h"
#include "support/xml.h"
#include "sweep/merge_sweep.h"
#include "sweep/run_sweep.h"

namespace cloth::test::sweep_account_test {
namespace {

namespace fs = std::filesystem;

/// Of a cloth of 5 x 5 particles for ten steps.
SweepPlan plan_of(const std::string& vary, const std::string& more) {
  SweepReading reading = read_sweep(R"({ "scene": "corners-free",
    "set": { "cloth.rows": 5, "cloth.columns": 5, "duration": 0.01, "integrator.time_step": 0.001 },
    "outputs": [ { "name": "elastic energy", "of": "elastic_J", "reduce": "max" },
                 { "name": "low", "of": "lowest_point" } ],
    "vary": )" + vary + more + "}",
                                    "account.sweep.json");
  for (const Problem& problem : reading.problems) ADD_FAILURE() << problem.text();
  return reading.plan.value_or(SweepPlan{});
}

const char* const three_ranges = R"([ { "path": "springs.structural", "from": 50, "to": 100 },
                                      { "path": "springs.shear", "from": 1, "to": 10, "scale": "log" },
                                      { "path": "integrator.method", "values": ["verlet", "rk4"] } ])";

struct MadeSweep {
  SweepFolder folder;
  SweepResults results;
};

MadeSweep made(const fs::path& path, const SweepPlan& plan) {
  MadeSweep sweep{take_sweep_folder(path, plan).folder.value(), {}};
  EXPECT_TRUE(run_sweep(sweep.folder, {}).is_complete());
  sweep.results = sweep_results(sweep.folder, read_shard_files(sweep.folder).files);
  return sweep;
}

TEST(SweepAccount, HasAColumnForEachAxisAndOutputInTheOrderOfThePoints) {
  const TemporaryFolder place;
  const MadeSweep sweep =
      made(place / "s", plan_of(three_ranges, R"(, "design": "saltelli", "samples": 4, "seed": 3)"));
  const PointsAccount account = points_account(sweep.folder, sweep.results);
  ASSERT_EQ(account.table.columns.size(), 5u);
  EXPECT_EQ(account.table.rows(), 4u * (3 + 2));
  EXPECT_EQ(account.design, Design::saltelli);
  EXPECT_EQ(account.table.columns[1].axis.scale, AxisScale::logarithmic);
  EXPECT_NE(account.table.columns[2].axis.label.find("0 verlet, 1 rk4"), std::string::npos)
      << account.table.columns[2].axis.label;
  const CsvTable table = sweep_table(sweep.folder.plan, sweep.results);
  EXPECT_EQ(account.table.columns[0].values, column_of(table, "springs.structural"));
  EXPECT_EQ(account.table.columns[3].values, column_of(table, "elastic energy"));
  for (std::size_t row = 0; row < account.table.rows(); ++row)
    EXPECT_EQ(account.table.columns[2].values[row], table.rows[row][3] == "rk4" ? 1 : 0);
}

TEST(SweepAccount, OfASampleLeavesPlacesForPointsThatAreMissing) {
  const TemporaryFolder place;
  MadeSweep sweep = made(place / "s", plan_of(three_ranges, R"(, "design": "morris", "samples": 5)"));
  const PointsAccount whole = points_account(sweep.folder, sweep.results);
  sweep.results.rows.erase(sweep.results.rows.begin() + 7);
  const PointsAccount lacking = points_account(sweep.folder, sweep.results);
  ASSERT_EQ(lacking.table.rows(), whole.table.rows());
  for (std::size_t row = 0; row < whole.table.rows(); ++row) {
    const double value = lacking.table.columns[3].values[row];
    EXPECT_TRUE(row == 7 ? std::isnan(value) : value == whole.table.columns[3].values[row]) << row;
  }
  EXPECT_EQ(lacking.table.notes[7], "point 7: not there yet");
}

TEST(SweepAccount, IsOfMoreThanTwoParametersOfSamplesAndOfTables) {
  const std::string two = R"([ { "path": "springs.structural", "from": 50, "to": 100, "count": 2 },
                               { "path": "springs.shear", "from": 1, "to": 10, "count": 2 } ])";
  EXPECT_FALSE(has_points(plan_of(two, "")));
  EXPECT_TRUE(has_points(plan_of(three_ranges, R"(, "design": "sobol", "samples": 4)")));
  const std::string one = R"([ { "path": "springs.structural", "from": 50, "to": 100 } ])";
  EXPECT_FALSE(has_points(plan_of(one, R"(, "design": "sobol", "samples": 4)"))) << "that is a curve";
}

TEST(Merge, OfASaltelliDesignLeavesTheIndicesOfEveryOutput) {
  const TemporaryFolder place;
  const MadeSweep sweep =
      made(place / "s", plan_of(three_ranges, R"(, "design": "saltelli", "samples": 8, "seed": 5)"));
  ASSERT_FALSE(write_merged(sweep.folder, sweep.results));
  for (const char* name : {"parallel-coordinates.svg", "main-effects.svg", "scatter-matrix.svg",
                           "sobol-elastic-energy.svg", "sobol-low.svg"})
    EXPECT_EQ(read_xml(content_of(sweep.folder.path / name)).error, "") << name;
  const CsvTable table = parse_csv(content_of(sweep.folder.path / "sweep.csv"));
  const SobolIndices indices = sobol_indices(column_of(table, "low"), 3, 5);
  const CsvTable csv = parse_csv(content_of(sweep.folder.path / "sobol-low.csv"));
  ASSERT_EQ(csv.rows.size(), 3u);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(column_of(csv, "s")[j], indices.parameters[j].first.value);
    EXPECT_EQ(column_of(csv, "st_high")[j], indices.parameters[j].total.high);
  }
  const std::string page = content_of(sweep.folder.path / "report.html");
  EXPECT_NE(page.find("What low depends on"), std::string::npos);
  EXPECT_EQ(page.find("There is no picture"), std::string::npos);
}

TEST(Merge, OfAGridOverThreeParametersLeavesEveryRunAndNoIndices) {
  const TemporaryFolder place;
  const std::string grid = R"([ { "path": "springs.structural", "from": 50, "to": 100, "count": 2 },
                                { "path": "springs.shear", "from": 1, "to": 10, "count": 2 },
                                { "path": "damping", "values": [0.001, 0.002] } ])";
  const MadeSweep sweep = made(place / "s", plan_of(grid, ""));
  ASSERT_FALSE(write_merged(sweep.folder, sweep.results));
  EXPECT_TRUE(fs::exists(sweep.folder.path / "main-effects.svg"));
  EXPECT_FALSE(fs::exists(sweep.folder.path / "sobol-low.csv"));
  EXPECT_NE(content_of(sweep.folder.path / "report.html").find("Parallel coordinates"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::sweep_account_test
