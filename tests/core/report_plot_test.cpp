#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "report/axis.h"
#include "report/heat_map.h"
#include "report/line_plot.h"
#include "report/line_plot_layout.h"
#include "report/plot_parts.h"
#include "support/random.h"
#include "support/xml.h"

namespace cloth::test::report_plot_test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Parsed, with every attribute that holds numbers free of NaN and infinity.
XmlElement checked(const std::string& svg) {
  const XmlDocument document = read_xml(svg);
  EXPECT_EQ(document.error, "");
  for (const XmlElement* element : all_elements(document.root))
    for (const char* key : {"d", "x", "y", "width", "height", "transform", "font-size", "viewBox"}) {
      const auto found = element->attributes.find(key);
      if (found == element->attributes.end()) continue;
      EXPECT_EQ(found->second.find("nan"), std::string::npos) << found->second;
      EXPECT_EQ(found->second.find("inf"), std::string::npos) << found->second;
    }
  return document.root;
}

std::vector<const XmlElement*> part(const XmlElement& root, const std::string& name) {
  std::vector<const XmlElement*> found;
  for (const XmlElement* element : all_elements(root))
    if (const auto it = element->attributes.find("data-part");
        it != element->attributes.end() && it->second == name)
      found.push_back(element);
  return found;
}

std::string tooltip(const XmlElement& element) {
  for (const XmlElement& child : element.children)
    if (child.name == "title") return child.text;
  return "";
}

std::vector<const XmlElement*> with_tooltips(const XmlElement& root) {
  std::vector<const XmlElement*> found;
  for (const XmlElement* element : all_elements(root))
    if (!tooltip(*element).empty()) found.push_back(element);
  return found;
}

std::string all_text(const XmlElement& root) {
  std::string text;
  for (const XmlElement* element : all_elements(root)) text += element->text + " ";
  return text;
}

/// The middle of a path's extent. Markers are drawn around their point; only M and L with absolute numbers.
SvgPoint middle(const std::string& data) {
  std::string numbers = data;
  for (char& c : numbers)
    if (std::isalpha(static_cast<unsigned char>(c))) c = ' ';
  std::istringstream in(numbers);
  double low_x = inf, high_x = -inf, low_y = inf, high_y = -inf;
  for (double x, y; in >> x >> y;) {
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  return {(low_x + high_x) / 2, (low_y + high_y) / 2};
}

LinePlot log_plot() {
  LinePlot plot;
  plot.title = "Error";
  plot.x = {.label = "run time", .unit = "s", .scale = AxisScale::logarithmic};
  plot.y = {.label = "error", .unit = "m", .scale = AxisScale::logarithmic};
  return plot;
}

TEST(Axis, LogarithmicTicksWithTextStandAtDecadesAndAreAllInTheRange) {
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    const double low = std::pow(10, random.uniform(-15, 8)),
                 high = low * std::pow(10, random.uniform(2.5, 14));
    const AxisMap map({.scale = AxisScale::logarithmic}, std::vector<double>{low, high}, 0, 600);
    int labels = 0;
    for (const Tick& tick : map.ticks(40)) {
      EXPECT_TRUE(map.holds(tick.value));
      if (!tick.major) continue;
      ++labels;
      EXPECT_EQ(tick.text, "10");
      const double exponent = std::log10(tick.value);
      EXPECT_NEAR(exponent, std::round(exponent), 1e-9);
      std::string superscript = tick.superscript;
      if (const std::size_t at = superscript.find("−"); at == 0)
        superscript = "-" + superscript.substr(std::string("−").size());
      EXPECT_EQ(std::stoi(superscript), int(std::lround(exponent)));
    }
    EXPECT_GE(labels, 2);
  }
}

TEST(Axis, TicksCoverTheRangeWithoutCrowding) {
  Random random;
  for (int trial = 0; trial < 500; ++trial) {
    const bool logs = random.coin();
    const double a = logs ? std::pow(10, random.uniform(-9, 3))
                          : random.uniform(-1, 1) * std::pow(10, random.integer(-8, 8));
    const double b = logs ? a * std::pow(10, random.uniform(0, 9))
                          : a + random.uniform(0.001, 1) * std::pow(10, random.integer(-8, 8));
    const Axis axis{.scale = logs ? AxisScale::logarithmic : AxisScale::linear};
    const AxisMap map(axis, std::vector<double>{a, b}, 0, 500);
    EXPECT_TRUE(map.holds(a) && map.holds(b));
    std::vector<double> at;
    for (const Tick& tick : map.ticks(50))
      if (tick.major) at.push_back(map.place(tick.value));
    ASSERT_GE(at.size(), 2u) << a << " " << b;
    EXPECT_LT(at.front(), 260) << a << " " << b;
    EXPECT_GT(at.back(), 240) << a << " " << b;
    for (std::size_t i = 1; i < at.size(); ++i) EXPECT_GT(at[i] - at[i - 1], 35) << a << " " << b;
  }
}

TEST(Axis, TickTextsOfALinearAxisDiffer) {
  for (const double offset : {0.0, 1.0, 1e6}) {
    const AxisMap map({}, std::vector<double>{offset + 0.1, offset + 0.2}, 0, 500);
    std::set<std::string> texts;
    const std::vector<Tick> ticks = map.ticks(50);
    for (const Tick& tick : ticks) texts.insert(tick.text);
    EXPECT_EQ(texts.size(), ticks.size()) << offset;
  }
}

TEST(Axis, HasARangeWhateverTheData) {
  const std::vector<std::vector<double>> cases = {{},
                                                  {0},
                                                  {5},
                                                  {-5, -5},
                                                  {nan, inf, -inf},
                                                  {0, -1},
                                                  {1e-320, 1e-310},
                                                  {1e308, -1e308},
                                                  {1e299},
                                                  {1e-300, 1e300},
                                                  {1, 1 + 1e-15}};
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic})
    for (const std::vector<double>& values : cases) {
      const AxisMap map({.scale = scale}, values, 0, 400);
      EXPECT_TRUE(std::isfinite(map.low()) && std::isfinite(map.high()));
      EXPECT_LT(map.low(), map.high());
      for (const Tick& tick : map.ticks(50)) EXPECT_TRUE(std::isfinite(map.place(tick.value)));
    }
}

TEST(LinePlot, PointsStandWhereTheLogarithmSays) {
  LinePlot plot = log_plot();
  plot.x.low = 1e-3, plot.x.high = 1e3, plot.y.low = 1e-8, plot.y.high = 1;
  plot.series = {
      {.name = "a", .points = {{1e-3, 1e-8}, {1, 1e-4}, {1e3, 1}, {10, 1e-6}}, .style = 3}};  // diamonds
  const XmlElement root = checked(to_svg(plot));
  const auto markers = with_tooltips(*part(root, "series").at(0));
  ASSERT_EQ(markers.size(), 4u);
  std::vector<SvgPoint> at;
  for (const XmlElement* marker : markers) at.push_back(middle(marker->attributes.at("d")));
  const SvgPoint low = at[0], high = at[2];
  EXPECT_NEAR(low.y - high.y, plot.plot_height, 0.1);
  EXPECT_NEAR(at[1].x, low.x + (high.x - low.x) * 3 / 6, 0.05);
  EXPECT_NEAR(at[1].y, low.y + (high.y - low.y) * 4 / 8, 0.05);
  EXPECT_NEAR(at[3].x, low.x + (high.x - low.x) * 4 / 6, 0.05);
  EXPECT_NEAR(at[3].y, low.y + (high.y - low.y) * 2 / 8, 0.05);
}

TEST(LinePlot, EveryFailedRunIsThereWithItsCause) {
  LinePlot plot = log_plot();
  std::vector<std::string> causes;
  for (int s = 0; s < 6; ++s) {
    PlotSeries& series = plot.series.emplace_back();
    series.name = "method " + std::to_string(s);
    for (int i = 0; i < 5; ++i) {
      causes.push_back("cause " + std::to_string(s) + "/" + std::to_string(i));
      series.failed.push_back({i == 3   ? nan
                               : i == 4 ? 0.0
                                        : 0.01,
                               causes.back()});  // the same place again and again
    }
  }
  const XmlElement root = checked(to_svg(plot));
  const auto markers = with_tooltips(*part(root, "failed").at(0));
  ASSERT_EQ(markers.size(), causes.size());
  std::set<std::string> places;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    EXPECT_NE(tooltip(*markers[i]).find(causes[i]), std::string::npos);
    places.insert(markers[i]->attributes.at("d"));
  }
  EXPECT_EQ(places.size(), causes.size());  // none hides another
  EXPECT_NE(all_text(*part(root, "legend").at(0)).find("failed"), std::string::npos);
}

TEST(LinePlot, SaysHowManyPointsItsAxesCannotShow) {
  LinePlot plot = log_plot();
  plot.series = {{.name = "a", .points = {{1, 1}, {2, 0}, {3, -1}, {4, nan}, {inf, 1}, {5, 2}}}};
  const XmlElement root = checked(to_svg(plot));
  EXPECT_EQ(with_tooltips(*part(root, "series").at(0)).size(), 2u);
  EXPECT_NE(all_text(root).find("4 points are left out"), std::string::npos);
  plot.series[0].points = {{1, 1}};
  EXPECT_EQ(to_svg(plot).find("left out"), std::string::npos);
}

TEST(LinePlot, SaysThatItHasNoData) {
  LinePlot plot = log_plot();
  plot.series = {{.name = "a", .points = {{0, 1}}}};
  EXPECT_NE(to_svg(plot).find(">no data<"), std::string::npos);
  plot.series[0].points = {{1, 1}};
  EXPECT_EQ(to_svg(plot).find(">no data<"), std::string::npos);
}

TEST(LinePlot, TheBestLineNeverRisesAndEndsAtTheFloor) {
  LinePlot plot = log_plot();
  plot.best_line = "best";
  plot.floor = PlotFloor{1e-6, "floor"};
  plot.series = {{.name = "a", .points = {{1, 1e-2}, {2, 1e-1}, {4, 1e-4}, {8, 1e-9}}},
                 {.name = "b", .points = {{3, 1e-3}, {16, 1e-8}}}};
  const XmlElement root = checked(to_svg(plot));
  std::string data = part(root, "best").at(0)->children.at(0).attributes.at("d");
  for (char& c : data)
    if (c == 'M' || c == 'L') c = ' ';
  std::istringstream in(data);
  const double floor = middle(part(root, "floor").at(0)->children.at(1).attributes.at("d")).y;
  double last_x = -inf, last_y = -inf;
  for (double x, y; in >> x >> y; last_x = x, last_y = y) {
    EXPECT_TRUE(x >= last_x && y >= last_y);
    EXPECT_TRUE(x == last_x || y == last_y || last_x == -inf);  // a staircase
  }
  EXPECT_NEAR(last_y, floor, 0.01);
}

TEST(LinePlot, IsValidWhateverTheData) {
  const std::vector<std::vector<PlotPoint>> cases = {{},
                                                     {{1, 1}},
                                                     {{2, 3}, {2, 3}, {2, 3}},
                                                     {{0, 0}},
                                                     {{-1, -1}, {-2, 5}},
                                                     {{nan, nan}, {inf, -inf}},
                                                     {{1e300, 1e-300}, {1e-300, 1e300}},
                                                     {{1, 1, std::pair{nan, inf}, std::pair{-1.0, 0.0}}}};
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic})
    for (const std::vector<PlotPoint>& points : cases)
      for (const double extra : {1.0, 0.0, -1.0, nan, inf}) {
        LinePlot plot = log_plot();
        plot.x.scale = plot.y.scale = scale;
        plot.series = {{.name = "a", .points = points, .failed = {{extra, "why"}}}, {}};
        plot.floor = PlotFloor{extra, "floor"};
        plot.lines = {{ReferenceLine::Direction::horizontal, extra, "h"},
                      {ReferenceLine::Direction::vertical, extra, "v"}};
        plot.triangles = {{extra, ""}, {2, ""}};
        plot.best_line = "best";
        checked(to_svg(plot));
      }
  checked(to_svg(LinePlot{}));
}

TEST(LinePlot, EscapesItsText) {
  const std::string nasty = "a<b> & \"c\" 'd' \x01 \xff ]]>";
  LinePlot plot;
  plot.title = plot.subtitle = nasty;
  plot.caption = {nasty};
  plot.x.label = plot.x.unit = plot.y.label = nasty;
  plot.series = {{.name = nasty, .detail = nasty, .points = {{1, 1, {}, {}, nasty}}, .failed = {{1, nasty}}}};
  plot.lines = {{ReferenceLine::Direction::horizontal, 1, nasty}};
  const std::string svg = to_svg(plot), drawn = all_text(checked(svg));
  EXPECT_NE(drawn.find("a<b> & \"c\" 'd' \xEF\xBF\xBD \xEF\xBF\xBD ]]>"), std::string::npos);
}

TEST(LinePlot, IsTheSameTextAgain) {
  LinePlot plot = log_plot();
  for (int s = 0; s < 12; ++s)
    plot.series.push_back(
        {.name = std::to_string(s), .points = {{0.1 + s, 1.0 / (1 + s)}, {20.0 + s, 1e-6}}});
  plot.triangles = {{-1, ""}, {-4, ""}};
  EXPECT_EQ(to_svg(plot), to_svg(LinePlot(plot)));
}

TEST(LinePlot, WhatLiesOutsideTheLimitsIsCutAtTheFrame) {
  LinePlot plot;
  plot.x.low = 0, plot.x.high = 1, plot.y.low = 0, plot.y.high = 1;
  plot.series = {{.name = "a", .points = {{-1, -1}, {2, 2}}}};
  const XmlElement root = checked(to_svg(plot));
  const XmlElement& series = *part(root, "series").at(0);
  ASSERT_EQ(series.children.size(), 1u);  // the line alone, from corner to corner; its points are outside
  plot.series = {{.name = "a", .points = {{0, 0}, {1, 1}}}};
  const XmlElement inside = checked(to_svg(plot));
  EXPECT_EQ(series.children[0].attributes.at("d"),
            part(inside, "series").at(0)->children[0].attributes.at("d"));
}

TEST(SlopeTriangles, HaveTheirSlopeAndKeepOffTheData) {
  const Axis log{.scale = AxisScale::logarithmic};
  const Box frame{100, 50, 700, 450};
  const AxisMap x(log, std::vector<double>{1e-3, 1e2}, frame.left, frame.right);
  const AxisMap y(log, std::vector<double>{1e-9, 1}, frame.bottom, frame.top);
  const std::vector<SlopeTriangle> wanted = {{-1, ""}, {-2, ""}, {4, ""}, {0.5, ""}};
  const std::vector<Box> data = {{100, 50, 400, 300}, {400, 250, 700, 450}};
  const std::vector<PlacedTriangle> placed = place_triangles(wanted, x, y, frame, data);
  ASSERT_EQ(placed.size(), wanted.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const PlacedTriangle& t = placed[i];
    const double decades_y = (t.along.y - t.up.y) / y.density(),
                 decades_x = (t.up.x - t.along.x) / x.density();
    EXPECT_NEAR(decades_y / decades_x, wanted[i].slope, 1e-9);
    const Box box{std::min(t.along.x, t.up.x), t.up.y, std::max(t.along.x, t.up.x), t.corner.y};
    EXPECT_EQ(covered(box, data), 0);
  }
  EXPECT_TRUE(place_triangles(wanted, AxisMap({}, {}, 0, 1), y, frame, {}).empty());
}

HeatMap small_map() {
  HeatMap map;
  map.x = {.label = "stiffness", .unit = "N/m", .scale = AxisScale::logarithmic};
  map.y = {.label = "time step", .unit = "s", .scale = AxisScale::logarithmic};
  map.x_values = {1, 10, 100, 1000}, map.y_values = {1e-4, 1e-3, 1e-2};
  for (int p = 0; p < 5; ++p) {
    HeatPanel& panel = map.panels.emplace_back();
    panel.title = "method " + std::to_string(p);
    for (int i = 0; i < 12; ++i) panel.cells.push_back({(i + p) % 5, "note " + std::to_string(i)});
    panel.curves = {{.label = "limit", .dash = Dash::dashed, .points = {{1, 1e-2}, {1000, 1e-4}}}};
  }
  return map;
}

TEST(HeatMap, HasEveryCellOfEveryPanelInTheColourOfItsClass) {
  const HeatMap map = small_map();
  const XmlElement root = checked(to_svg(map));
  const auto panels = part(root, "panel");
  ASSERT_EQ(panels.size(), 5u);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    std::size_t cells = 0;
    const auto groups = part(*panels[p], "class");
    ASSERT_EQ(groups.size(), map.classes.size());
    for (std::size_t c = 0; c < groups.size(); ++c) {
      EXPECT_EQ(groups[c]->attributes.at("fill"), map.classes[c].colour.light);
      for (const XmlElement& cell : groups[c]->children) {
        ++cells;
        EXPECT_NE(tooltip(cell).find(map.classes[c].name), std::string::npos);
      }
    }
    EXPECT_EQ(cells, 12u);
  }
  EXPECT_NE(all_text(*part(root, "legend").at(0)).find("limit"), std::string::npos);
}

TEST(HeatMap, TheFirstCellIsLowestAndCellsTouch) {
  HeatMap map = small_map();
  map.panels.resize(1);
  for (HeatCell& cell : map.panels[0].cells) cell.class_index = 0;
  const XmlElement root = checked(to_svg(map));
  const auto& cells = part(root, "class").at(0)->children;
  const auto number = [&](std::size_t i, const char* key) { return std::stod(cells[i].attributes.at(key)); };
  EXPECT_GT(number(0, "y"), number(4, "y"));
  EXPECT_GT(number(4, "y"), number(8, "y"));
  EXPECT_LT(number(0, "x"), number(1, "x"));
  EXPECT_GE(number(0, "x") + number(0, "width"), number(1, "x"));
  EXPECT_GE(number(4, "y") + number(4, "height"), number(0, "y"));
  EXPECT_NE(tooltip(cells[1]).find("stiffness: 10 N/m"), std::string::npos);
}

TEST(HeatMap, IsValidWhateverTheData) {
  checked(to_svg(HeatMap{}));
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{}, {1}, {0, 1}, {nan, 1}, {2, 1}, {1, 2}}) {
    HeatMap map = small_map();
    map.x_values = map.y_values = values;
    for (HeatPanel& panel : map.panels) {
      panel.cells.assign(values.size() * values.size(), {7, "no class"});
      panel.curves = {
          {.label = "<&>", .points = {{nan, 1}, {0, 1}, {1, inf}, {1, 1}, {1e9, 1e9}, {2, 1e-9}}}};
    }
    checked(to_svg(map));
  }
}

}  // namespace
}  // namespace cloth::test::report_plot_test
