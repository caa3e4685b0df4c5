// Plots of points, sensitivity and fits: what they show, and that they can be read everywhere.
// CLOTHLAB_WRITE_PICTURES=1 writes the pictures of docs/studies/sensitivity.md anew.
#include "analysis/points_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>

#include "analysis/fit_report.h"
#include "analysis/sensitivity_report.h"
#include "report/ramp.h"
#include "support/xml.h"

namespace cloth::test::points_report_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Ishigami's function over [-pi, pi]^3, and what else comes of it.
double ishigami(const UnitPoint& point) {
  const auto x = [&](std::size_t j) { return std::numbers::pi * (2 * point[j] - 1); };
  return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

PointsAccount account_of(Design design, std::size_t count) {
  PointsAccount account{.title = "Ishigami's function", .command = "clothlab-cli sweep ishigami.sweep.json"};
  account.design = design, account.count = count;
  const UnitPoints rows = unit_design(design, count, 3, 1);
  for (std::size_t j = 0; j < 3; ++j) {
    PointColumn column{.axis = {.label = "x" + std::to_string(j + 1), .unit = "rad"}};
    for (const UnitPoint& row : rows) column.values.push_back(std::numbers::pi * (2 * row[j] - 1));
    account.table.columns.push_back(column);
  }
  PointColumn output{.axis = {.label = "f"}, .is_output = true};
  for (const UnitPoint& row : rows) output.values.push_back(ishigami(row));
  account.table.columns.push_back(output);
  return account;
}

std::vector<const XmlElement*> group_of(const XmlDocument& document, const std::string& part) {
  for (const XmlElement* element : all_elements(document.root))
    if (element->attributes.contains("data-part") && element->attributes.at("data-part") == part)
      return all_elements(*element);
  return {};
}

std::size_t count_of(const std::vector<const XmlElement*>& elements, const std::string& name) {
  return static_cast<std::size_t>(
      std::count_if(elements.begin(), elements.end(), [&](const XmlElement* e) { return e->name == name; }));
}

TEST(Sensitivity, OfAnOutputThatHardlyVariesSaysSo) {
  const UnitPoints rows = unit_design(Design::saltelli, 64, 2, 1);
  const auto said = [&](double spread) {
    std::vector<double> outputs;
    for (const UnitPoint& row : rows) outputs.push_back(5 + spread * row[0]);
    for (const std::string& sentence : sentences_of(sobol_indices(outputs, 2), {"a", "b"}, "peak"))
      if (sentence.find("peak hardly varies") != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(said(1e-3));
  EXPECT_FALSE(said(1));
}

TEST(PointTable, KnowsWhichRowsFailed) {
  PointsAccount account = account_of(Design::sobol, 8);
  account.table.columns[3].values[5] = none;
  EXPECT_TRUE(account.table.failed(5));
  EXPECT_FALSE(account.table.failed(4));
  EXPECT_EQ(account.table.failures(), 1u);
  EXPECT_NE(account.table.text_of(5).find("run 6\nx1: "), std::string::npos);
  EXPECT_NE(account.table.text_of(5).find("f: no value"), std::string::npos);
}

TEST(RankCorrelation, IsOneOfWhatRisesTogetherHoweverItDoes) {
  std::vector<double> x, up, down;
  for (int k = 0; k < 20; ++k) x.push_back(k), up.push_back(std::exp(k)), down.push_back(-k * k * k);
  EXPECT_NEAR(rank_correlation(x, up), 1, 1e-12);
  EXPECT_NEAR(rank_correlation(x, down), -1, 1e-12);
  // By hand: ranks 1 2 3 4 5 and 2 1 4 3 5: 1 - 6 (1 + 1 + 1 + 1)/(5 * 24) = 0.8.
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4, 5}, {20, 10, 40, 30, 50}), 0.8, 1e-12);
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4, 5, 6}, {20, 10, 40, 30, 50, none}), 0.8, 1e-12);
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2, 3}, {4, 4, 4})));
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2}, {4, 5})));
}

TEST(MeanAlong, IsThatOfTheRowsInEachIntervalOrAtEachValue) {
  const std::vector<double> x{3, 1, 2, 1, 3, 2}, y{30, 10, 20, 12, 34, none};
  const auto at_values = mean_along(x, y, 5);
  ASSERT_EQ(at_values.size(), 3u);
  EXPECT_EQ(at_values[0].y, 11);
  EXPECT_EQ(at_values[1].y, 20);
  EXPECT_EQ(at_values[2].y, 32);
  const auto in_two = mean_along({1, 2, 3, 4}, {1, 3, 5, 9}, 2);
  ASSERT_EQ(in_two.size(), 2u);
  EXPECT_EQ(in_two[0].x, 1.5);
  EXPECT_EQ(in_two[1].y, 7);
}

TEST(RampColours, CanBeSeenOnBothPapersAndFollowTheValue) {
  for (const PageColour& colour : ramp_colours()) {
    EXPECT_GE(contrast(colour.light, page_colours().surface.light), 3) << colour.name;
    EXPECT_GE(contrast(colour.dark, page_colours().surface.dark), 3) << colour.name;
  }
  EXPECT_EQ(ramp_class(0, 0, 1), 0u);
  EXPECT_EQ(ramp_class(1, 0, 1), 6u);
  EXPECT_EQ(ramp_class(0.5, 0, 1), 3u);
  EXPECT_EQ(ramp_class(2, 0, 1), 6u);
  EXPECT_EQ(ramp_class(5, 5, 5), 3u);
}

TEST(ParallelCoordinates, HaveALineForEachRunAndAnAxisForEachColumn) {
  PointsAccount account = account_of(Design::sobol, 64);
  account.table.columns[3].values[7] = none;
  const XmlDocument document = read_xml(to_svg(parallel_plot(account)));
  ASSERT_EQ(document.error, "");
  EXPECT_EQ(count_of(group_of(document, "rows"), "path"), 64u);
  EXPECT_EQ(count_of(group_of(document, "failed"), "path"), 1u);
  EXPECT_EQ(count_of(group_of(document, "bars"), "rect"), 4u);
}

TEST(ParallelCoordinates, HaveBarsWhereTheLinesBend) {
  // The script of the page finds the value of a line on an axis by the place of the axis' bar.
  const XmlDocument document = read_xml(to_brushed_svg(parallel_plot(account_of(Design::sobol, 16))));
  ASSERT_EQ(document.error, "");
  std::set<std::string> places;
  for (const XmlElement* bar : group_of(document, "bars"))
    if (bar->name == "rect")
      places.insert(
          svg_number(std::stod(bar->attributes.at("x")) + std::stod(bar->attributes.at("width")) / 2));
  ASSERT_EQ(places.size(), 4u);
  for (const XmlElement* line : group_of(document, "rows")) {
    if (line->name != "path") continue;
    std::istringstream corners(line->attributes.at("d").substr(1));
    std::string corner;
    while (std::getline(corners, corner, 'L'))
      EXPECT_TRUE(places.contains(corner.substr(0, corner.find(' ')))) << corner;
  }
  EXPECT_EQ(count_of(all_elements(document.root), "script"), 1u);
}

TEST(ParallelCoordinates, DrawRunsOutsideOfAnyBrushFaintlyAndCountTheOthers) {
  PointsAccount account = account_of(Design::sobol, 64);
  account.table.columns[3].values[7] = none;
  ParallelCoordinates plot = parallel_plot(account);
  plot.brushes = {{.column = 0, .low = 0, .high = 4}, {.column = 3, .low = -100, .high = 100}};
  std::size_t kept = 0;
  for (std::size_t row = 0; row < 64; ++row) {
    const bool inside = account.table.columns[0].values[row] >= 0 && row != 7;  // which has no output
    EXPECT_EQ(is_kept(plot, row), inside) << row;
    kept += inside ? 1 : 0;
  }
  const XmlDocument document = read_xml(to_svg(plot));
  ASSERT_EQ(document.error, "");
  EXPECT_EQ(count_of(group_of(document, "rows"), "path"), 64u);
  EXPECT_EQ(count_of(group_of(document, "faint"), "path"), 64 - kept);
  EXPECT_EQ(count_of(group_of(document, "faint"), "title"), 0u);
  EXPECT_EQ(kept_words(plot), std::to_string(kept) + " of 64 runs");
  EXPECT_NE(to_svg(plot).find(kept_words(plot)), std::string::npos);
}

TEST(ParallelCoordinates, SayWhereTheirAxesAre) {
  const ParallelCoordinates plot = parallel_plot(account_of(Design::sobol, 16));
  const XmlDocument document = read_xml(to_svg(plot));
  const auto axes = axes_of(plot);
  std::size_t c = 0;
  for (const XmlElement* bar : group_of(document, "bars")) {
    if (bar->name != "rect") continue;
    ASSERT_LT(c, axes.size());
    EXPECT_EQ(bar->attributes.at("x"), svg_number(axes[c].x - parallel_bar_width / 2));
    EXPECT_EQ(bar->attributes.at("y"), svg_number(axes[c].top));
    EXPECT_EQ(bar->attributes.at("height"), svg_number(axes[c].bottom - axes[c].top));
    ++c;
  }
  EXPECT_EQ(c, axes.size());
}

TEST(AxisMap, GivesTheValueOfAPlaceBack) {
  const std::vector<double> values{0.02, 3, 170};
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
    const AxisMap map({.scale = scale}, values, 400, 100);  // upwards
    for (const double value : values) EXPECT_NEAR(map.value_at(map.place(value)), value, 1e-12 * 170);
    EXPECT_DOUBLE_EQ(map.value_at(1000), map.low());
    EXPECT_DOUBLE_EQ(map.value_at(-1000), map.high());
  }
}

TEST(ParallelCoordinates, OfManyRunsDrawSomeAndSaySo) {
  const std::string svg = to_svg(parallel_plot(account_of(Design::sobol, 4096)));
  EXPECT_EQ(count_of(group_of(read_xml(svg), "rows"), "path"), most_parallel_rows);
  EXPECT_NE(svg.find("2000 of 4096 runs are drawn"), std::string::npos);
}

TEST(ScatterMatrices, AreWellFormedForAnyTable) {
  PointsAccount account = account_of(Design::sobol, 32);
  account.table.columns[0].axis.scale = AxisScale::logarithmic;  // half of its values cannot be shown
  account.table.columns[3].values[3] = none;
  EXPECT_EQ(read_xml(to_svg(scatter_plot(account))).error, "");
  EXPECT_EQ(read_xml(to_svg(main_effects_plot(account))).error, "");
  account.table = {};
  EXPECT_EQ(read_xml(to_svg(scatter_plot(account))).error, "");
  EXPECT_EQ(read_xml(to_svg(main_effects_plot(account))).error, "");
  EXPECT_EQ(read_xml(to_brushed_svg(parallel_plot(account))).error, "");
}

TEST(SensitivityReport, SaysWhatDecides) {
  const PointsAccount account = account_of(Design::saltelli, 4096);
  const std::vector<std::string> names{"x1", "x2", "x3"};
  const SobolIndices indices = sobol_indices(account.table.columns[3].values, 3);
  const auto sentences = sentences_of(indices, names, "f");
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[0], "x1 decides most: 31 % of the variance of f alone, 56 % with others.");
  EXPECT_NE(sentences[1].find(" % of the variance come from parameters acting together."), std::string::npos);
  const IntervalBars bars = sobol_plot(indices, names, "f");
  EXPECT_EQ(bars.categories, (std::vector<std::string>{"x1", "x2", "x3"}));
  EXPECT_EQ(read_xml(to_svg(bars)).error, "");
  EXPECT_EQ(sobol_csv(indices, names).substr(0, 42), "parameter,s,s_low,s_high,st,st_low,st_high");
}

TEST(SensitivityReport, OfNothingSaysThat) {
  const std::vector<double> constant(20, 3);
  EXPECT_EQ(sentences_of(sobol_indices(constant, 3), {"a", "b", "c"}, "f")[0],
            "f is the same in every run: nothing decides it.");
  EXPECT_EQ(
      sentences_of(morris_screening(unit_design(Design::morris, 5, 3, 1), constant), {"a", "b", "c"}, "f")[0],
      "No parameter has an effect on f that could be had.");
}

TEST(PointsPage, HasTheSectionsThatApply) {
  const std::string saltelli = points_page(account_of(Design::saltelli, 64));
  for (const char* part : {"Every run", "What f depends on", "Every pair", "<script>", "clothlab-cli sweep"})
    EXPECT_NE(saltelli.find(part), std::string::npos) << part;
  for (const char* word : {"http", "url(", "@import", "<link", "src="})
    EXPECT_EQ(saltelli.find(word), std::string::npos) << word;
  EXPECT_NE(points_page(account_of(Design::morris, 10)).find("What changes f"), std::string::npos);
  PointsAccount plain = account_of(Design::sobol, 16);
  plain.design.reset();
  EXPECT_EQ(points_page(plain).find("depends on"), std::string::npos);
}

TEST(PointsPage, OfOneParameterHasACurveOfEachOutputInItsOrder) {
  PointsAccount account{.title = "A line"};
  account.table.columns = {{.axis = {.label = "k"}, .values = {3, 1, 2}},
                           {.axis = {.label = "y"}, .is_output = true, .values = {30, 10, none}}};
  const LinePlot plot = curve_of_output(account, 1);
  ASSERT_EQ(plot.series.size(), 1u);
  ASSERT_EQ(plot.series[0].points.size(), 2u);
  EXPECT_EQ(plot.series[0].points[0].x, 1);
  EXPECT_EQ(plot.series[0].points[1].y, 30);
  ASSERT_EQ(plot.series[0].failed.size(), 1u);
  EXPECT_EQ(plot.series[0].failed[0].x, 2);
  EXPECT_NE(points_page(account).find("Runs without a value: 1 of 3."), std::string::npos);
}

/// A damped swing: frequency and decay from a noisy curve, by its own formula.
FitAccount swing_account() {
  FitAccount account{.title = "A damped swing", .command = "clothlab-cli identify swing --vary damping"};
  account.problem.parameters = {{"frequency", "1/s", 1, 20}, {"decay", "1/s", 0.05, 5}};
  FitCurve curve{.name = "displacement",
                 .x = {.label = "time", .unit = "s"},
                 .y = {.label = "displacement", .unit = "m"}};
  const auto at = [](const std::vector<double>& p, double t) {
    return 0.1 * std::exp(-p[1] * t) * std::cos(p[0] * t);
  };
  for (int k = 0; k < 40; ++k) {
    curve.at.push_back(0.05 * k);
    curve.targets.push_back(static_cast<std::size_t>(k));
    const double noise = 0.004 * std::sin(12.9898 * k * k + 78.233 * k);
    account.problem.targets.push_back(
        {.name = "displacement", .unit = "m", .measured = at({7, 0.6}, 0.05 * k) + noise, .sigma = 0.003});
  }
  account.problem.evaluate = [=](const std::vector<std::vector<double>>& points) {
    std::vector<std::vector<double>> all;
    for (const auto& point : points) {
      all.emplace_back();
      for (int k = 0; k < 40; ++k) all.back().push_back(at(point, 0.05 * k));
    }
    return all;
  };
  account.options.starts = 40, account.options.descents = 8;
  account.result = fit(account.problem, account.options);
  account.curves = {curve};
  return account;
}

TEST(FitReport, HasValuesVerdictsAndCurves) {
  const FitAccount account = swing_account();
  ASSERT_EQ(account.result.status, FitStatus::converged);
  EXPECT_NEAR(account.result.parameters[0].value, 7, 0.1);
  EXPECT_EQ(read_xml(to_svg(curve_plot(account, account.curves[0]))).error, "");
  EXPECT_EQ(read_xml(to_svg(residual_plot(account, &account.curves[0]))).error, "");
  const std::string page = fit_page(account), text = fit_text(account);
  for (const char* part : {"The data identify frequency, decay.", "When a parameter is identified",
                           "Correlations", "Combination", "Figure 2"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_NE(text.find("identified"), std::string::npos) << text;
  EXPECT_NE(parameters_csv(account).find("\nfrequency,1/s,"), std::string::npos);
  EXPECT_NE(fit_json(account).find("\"format\": \"clothlab/fit/1\""), std::string::npos);
}

/// Of the documentation: they are what the code draws now.
TEST(SensitivityPictures, AreThoseOfTheDocumentation) {
  const std::vector<std::string> names{"x1", "x2", "x3"};
  const PointsAccount sobol = account_of(Design::saltelli, 1024), morris = account_of(Design::morris, 20),
                      few = account_of(Design::latin_hypercube, 120);
  const std::pair<const char*, std::string> pictures[] = {
      {"sensitivity-sobol.svg",
       to_svg(sobol_plot(sobol_indices(sobol.table.columns[3].values, 3), names, "f"))},
      {"sensitivity-morris.svg", to_svg(morris_plot(morris_screening(unit_design(Design::morris, 20, 3, 1),
                                                                     morris.table.columns[3].values),
                                                    names, "f", ""))},
      {"sensitivity-parallel.svg", to_svg(parallel_plot(few))},
      {"sensitivity-main-effects.svg", to_svg(main_effects_plot(few))},
      {"sensitivity-scatter.svg", to_svg(scatter_plot(few))}};
  for (const auto& [name, svg] : pictures) {
    const std::string path = std::string(CLOTHLAB_SOURCE_DIR) + "/docs/pictures/" + name;
    if (const char* write = std::getenv("CLOTHLAB_WRITE_PICTURES"); write && *write)
      std::ofstream(path, std::ios::binary) << svg;
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    EXPECT_TRUE(text.str() == svg) << "CLOTHLAB_WRITE_PICTURES=1 with this test writes " << path << " anew";
  }
}

}  // namespace
}  // namespace cloth::test::points_report_test
