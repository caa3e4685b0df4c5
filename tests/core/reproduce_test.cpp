#include "study/reproduce.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/csv.h"
#include "io/file_digest.h"
#include "io/json_entry.h"
#include "io/text_file.h"
#include "study/reproduce/errata.h"
#include "support/files.h"

namespace cloth::test::reproduce_test {
namespace {

/// Made once: the parts that measure no times.
class Reproduce : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    result_ = reproduce({.folder = folder_->path(), .only = {"errata", "fig1"}});
    page_ = content_of(*folder_ / "report.html");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static double number(const std::string& name) {
    for (const Measured& measured : result_.numbers)
      if (measured.name == name) return measured.value;
    ADD_FAILURE() << "no number " << name;
    return std::nan("");
  }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline ReproduceResult result_;
  static inline std::string page_;
};

/// One unit of the last digit that the page gives of an expected number; of one without an end, a part in
/// 10^4.
double digit_of(double expected) {
  const std::string text = fmt::format("{}", expected);
  const std::size_t point = text.find('.');
  const auto decimals = point == std::string::npos ? 0 : static_cast<int>(text.size() - point) - 1;
  return std::max(std::pow(10.0, -decimals), 1e-4 * std::abs(expected));
}

TEST_F(Reproduce, EveryNumberIsTheOneThatThePageExpects) {
  int compared = 0;
  for (const Measured& measured : result_.numbers) {
    if (!measured.expected || measured.name.find("order") != std::string::npos) continue;
    EXPECT_NEAR(measured.value, *measured.expected, digit_of(*measured.expected)) << measured.name;
    ++compared;
  }
  EXPECT_GE(compared, 15);
}

/// x' = -x over a step from 1, the slopes weighted 1, 2, 3, 1 as printed.
double printed_decay(double h) {
  const double k1 = -1, k2 = -(1 + h / 2 * k1), k3 = -(1 + h / 2 * k2), k4 = -(1 + h * k3);
  return 1 + h / 6 * (k1 + 2 * k2 + 3 * k3 + k4);
}

TEST_F(Reproduce, PrintedRungeKuttaDoesNotConverge) {
  EXPECT_NEAR(number("3 k3: error of x' = -x at t = 1, 320 steps"),
              std::abs(std::pow(printed_decay(1.0 / 320), 320) - std::exp(-1)), 1e-12);
  EXPECT_NEAR(number("3 k3: turns per period"), 7.0 / 6, 1e-4);
  EXPECT_NEAR(number("2 k3: turns per period"), 1, 1e-9);
  EXPECT_NEAR(number("Runge-Kutta 4 with 3 k3, Eq. (8): order"), 0, 0.05);
  EXPECT_NEAR(number("Runge-Kutta 4: order"), 4, 0.1);
  EXPECT_GT(number("Runge-Kutta 4 with 3 k3: error that stays"), 1e-2);
}

TEST_F(Reproduce, LaggedVerletIsOfFirstOrderAndCentredOfSecond) {
  EXPECT_NEAR(number("Verlet with lagged damping, Eq. (14): order"), 1, 0.05);
  EXPECT_NEAR(number("Verlet, damping centred: order"), 2, 0.05);
}

TEST_F(Reproduce, CurrentLengthHookeCollapsesTheCloth) {
  // Two structural springs of 0.1 m, a shear one across a cell, two flexion springs of 0.2 m, 100 N/m each:
  // 0.4 m of spring along either side. What the first Runge-Kutta step shows of it is short by a relative
  // h^2.
  const double force = 100 * 0.4 * std::sqrt(2);
  EXPECT_NEAR(number("F = -k l: force on a corner at rest"), force, 1e-3 * force);
  EXPECT_NEAR(number("F = -k l: acceleration of a corner"), force / (0.01 * 9.81),
              1e-3 * force / (0.01 * 9.81));
  EXPECT_NEAR(number("F = -k l: radius at the start"), 0.45 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(number("F = -k l: least radius"), 0.039, 5e-4);
  EXPECT_NEAR(number("F = -k l: time of the collapse"), 0.0195, 1e-4);
}

TEST_F(Reproduce, CornerPushIsFourTimesTheLeastPenetration) {
  // The mean distance of a cube's points from a corner, and of the least of three numbers from 0.
  const double mean = std::sqrt(3) / 4 + std::log(2 + std::sqrt(3)) / 2 - std::numbers::pi / 24;
  EXPECT_NEAR(number("all three, mean over the cube"), mean, 5e-4);
  EXPECT_NEAR(number("least penetration, mean over the cube"), 0.25, 5e-4);
  EXPECT_NEAR(number("all three: speed of that jump"), std::hypot(0.9, 0.01, 0.8) * 0.5 / 1e-3, 1e-9);
  EXPECT_NEAR(number("least penetration: speed of that jump"), 5, 1e-9);
}

TEST_F(Reproduce, SemiImplicitEulerGrowsBeyondItsLimitAndImplicitEulerDoesNot) {
  EXPECT_NEAR(number("semi-implicit Euler, w = 1.9"), 1, 1e-9);
  const auto radius = [](double w) { return (w * w - 2 + w * std::sqrt(w * w - 4)) / 2; };
  EXPECT_NEAR(number("semi-implicit Euler, w = 2.1"), radius(2.1), 1e-9);
  EXPECT_NEAR(number("semi-implicit Euler, w = 10"), radius(10), 1e-9);
  EXPECT_NEAR(number("implicit Euler, w = 2.1"), 1 / std::hypot(1, 2.1), 1e-9);
  EXPECT_NEAR(number("implicit Euler, w = 10"), 1 / std::hypot(1, 10), 1e-9);
  EXPECT_EQ(number("corners-free at 0.95 of the limit: steps until it diverged (0: never)"), 0);
  EXPECT_GT(number("corners-free at 1.1 of the limit: steps until it diverged (0: never)"), 0);
}

TEST(LeavingParticle, IsSentBackInAsPrintedAndLeftAloneOtherwise) {
  const auto [printed, right] = leaving_particle();
  EXPECT_NEAR(printed.velocity, -0.9, 1e-12);
  EXPECT_NEAR(right.velocity, 1, 1e-12);
  EXPECT_GT(printed.time_lost, 0);
}

TEST_F(Reproduce, ReportIsOneFileWithEverySection) {
  for (const char* section : {"Fig. 1", "Eqs. (8) and (14)", "Eq. (1)", "Eqs. (17) and (20)",
                              "Eqs. (6) and (7)", "Machine and measurement"})
    EXPECT_NE(page_.find(section), std::string::npos) << section;
  EXPECT_EQ(page_.find("src=\"http"), std::string::npos);
  EXPECT_EQ(page_.find("<link"), std::string::npos);
  EXPECT_EQ(page_.find("<script"), std::string::npos);
  EXPECT_NE(page_.find("clothlab-cli reproduce --only errata"), std::string::npos);
}

TEST_F(Reproduce, EveryFileIsThereAndEveryNumberIsFinite) {
  EXPECT_FALSE(result_.io_error);
  for (const std::string& file : result_.files) EXPECT_FALSE(content_of(*folder_ / file).empty()) << file;
  EXPECT_EQ(content_of(*folder_ / "fig1-springs.png").substr(1, 3), "PNG");
  const CsvTable table = parse_csv(content_of(*folder_ / "numbers.csv"));
  EXPECT_EQ(table.rows.size(), result_.numbers.size());
  for (const Measured& measured : result_.numbers)
    EXPECT_TRUE(std::isfinite(measured.value)) << measured.name;
}

TEST_F(Reproduce, GivesTheSameNumbersAgain) {
  const TemporaryFolder folder;
  const ReproduceResult again = reproduce({.folder = folder.path(), .only = {"errata"}});
  std::map<std::string, double> first;
  for (const Measured& measured : result_.numbers) first[measured.name] = measured.value;
  for (const Measured& measured : again.numbers) EXPECT_EQ(measured.value, first[measured.name]);
}

TEST(StoppedReproduction, LeavesAPageOfWhatWasDone) {
  const TemporaryFolder folder;
  const ReproduceResult result = reproduce(
      {.folder = folder.path(), .progress = [](const ReproduceProgress& p) { return p.part == "fig1"; }});
  EXPECT_TRUE(result.stopped);
  const std::string page = content_of(folder / "report.html");
  EXPECT_NE(page.find("Fig. 1"), std::string::npos);
  EXPECT_NE(page.find("Stopped before the end"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(page.find("Table 1: 2500"), std::string::npos);
}

TEST(StoppedReproduction, GoesOnAfterItsLastWholePartToTheSamePage) {
  const auto without_date = [](std::string page) {
    const auto at = page.find("Date");
    return at == std::string::npos ? page : page.erase(at, page.find("</tr>", at) - at);
  };
  const ReproduceOptions parts{.only = {"fig1", "errata"}};
  const TemporaryFolder whole, stopped;
  ReproduceOptions options = parts;
  options.folder = whole.path();
  reproduce(options);
  options.folder = stopped.path();
  options.progress = [](const ReproduceProgress& p) { return p.part == "fig1"; };
  EXPECT_TRUE(reproduce(options).stopped);
  options.progress = {};
  int there = 0;
  options.goes_on = [&](int count) { there = count; };
  const ReproduceResult result = reproduce(options);
  EXPECT_FALSE(result.stopped);
  EXPECT_EQ(there, 1);
  EXPECT_EQ(content_of(stopped / "numbers.csv"), content_of(whole / "numbers.csv"));
  EXPECT_EQ(without_date(content_of(stopped / "report.html")),
            without_date(content_of(whole / "report.html")));
  const auto index = nlohmann::ordered_json::parse(content_of(stopped / "reproduce.json"));
  const std::vector<FileDigest> digests = digests_of(JsonEntry(index.at("files")));
  EXPECT_EQ(digests.size(), result.files.size());
  for (const FileDigest& file : digests)
    EXPECT_EQ(
        disagreement(file, digest_of(file.name, content_of(stopped / file.name), file.rows.has_value())), "")
        << file.name;
}

TEST(StoppedReproduction, BeginsAnewWhereAFileOfAFinishedPartIsNotTheOneThatWasWritten) {
  const TemporaryFolder folder;
  ReproduceOptions options{.folder = folder.path(), .only = {"fig1", "errata"}};
  options.progress = [](const ReproduceProgress& p) { return p.part == "fig1"; };
  const ReproduceResult first = reproduce(options);
  ASSERT_TRUE(first.stopped);
  ASSERT_FALSE(write_text_file(folder / first.files.front(), "another picture"));
  bool goes_on = false;
  options.goes_on = [&](int) { goes_on = true; };
  reproduce(options);
  EXPECT_FALSE(goes_on);
  EXPECT_NE(content_of(folder / first.files.front()), "another picture");
}

TEST(StoppedReproduction, IsLeftAloneByOneOfOtherParts) {
  const TemporaryFolder folder;
  reproduce({.folder = folder.path(), .only = {"fig1", "errata"}, .progress = [](const ReproduceProgress& p) {
               return p.part == "fig1";
             }});
  const ReproduceResult other = reproduce({.folder = folder.path(), .only = {"fig1"}});
  ASSERT_TRUE(other.io_error);
  EXPECT_TRUE(other.io_error->refused);
  EXPECT_TRUE(std::filesystem::exists(folder / "reproduce.json"));
  EXPECT_FALSE(reproduce({.folder = folder.path(), .only = {"fig1"}, .overwrite = true}).io_error);
}

}  // namespace
}  // namespace cloth::test::reproduce_test
