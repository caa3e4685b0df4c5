#include "report/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/ramp.h"

namespace cloth {
namespace {

// At least 3 : 1 against the surface of their scheme, as WCAG 2.1 asks of graphics.
const std::vector<PageColour>& series_colours() {
  static const std::vector<PageColour> colours = {
      {"blue", "#0072b2", "#4fa8e8"},   {"vermillion", "#d55e00", "#ff8540"}, {"green", "#008f68", "#2fc79a"},
      {"purple", "#b0508a", "#e394c3"}, {"black", "#1f2328", "#f0f3f6"},      {"amber", "#b27700", "#f0ad2e"},
      {"sky", "#2e94cc", "#93d3fb"},    {"olive", "#857a00", "#efe35a"},
  };
  return colours;
}

double channel(const std::string& colour, int index) {
  const double value = std::stoi(colour.substr(1 + 2 * std::size_t(index), 2), nullptr, 16) / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double luminance(const std::string& colour) {
  return 0.2126 * channel(colour, 0) + 0.7152 * channel(colour, 1) + 0.0722 * channel(colour, 2);
}

}  // namespace

SeriesStyle style_of_series(int index) {
  constexpr std::array markers = {Marker::circle,        Marker::square, Marker::triangle_up, Marker::diamond,
                                  Marker::triangle_down, Marker::cross,  Marker::pentagon,    Marker::hexagon,
                                  Marker::star,          Marker::plus};
  constexpr std::array dashes = {Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted};
  const std::vector<PageColour>& colours = series_colours();
  const auto i = std::size_t(std::max(index, 0));
  return {colours[i % colours.size()], markers[i % markers.size()],
          dashes[i / colours.size() % dashes.size()]};
}

const std::vector<ClassStyle>& run_classes() {
  static const std::vector<ClassStyle> classes = {
      {"accurate", {"accurate", "#5fb4e5", "#3f9fd6"}, CellMark::none},
      {"stable but inaccurate", {"inaccurate", "#cfe8f7", "#1d4560"}, CellMark::dot},
      {"energy growth", {"growth", "#f5d04c", "#c29a1c"}, CellMark::slash},
      {"diverged", {"diverged", "#d55e00", "#c2500a"}, CellMark::cross},
      {"solver failed", {"solverfailed", "#4b4b57", "#9a9aa8"}, CellMark::ring},
  };
  return classes;
}

const PageColours& page_colours() {
  static const PageColours colours = {{"surface", "#ffffff", "#14171c"},
                                      {"ink", "#1f2328", "#e6e9ed"},
                                      {"muted", "#596069", "#a2abb6"},
                                      {"grid", "#e4e7eb", "#2a3038"},
                                      {"band", "#e9ebee", "#252a31"}};
  return colours;
}

std::vector<PageColour> all_colours() {
  const PageColours& page = page_colours();
  std::vector<PageColour> all = {page.surface, page.ink, page.muted, page.grid, page.band};
  for (const PageColour& colour : series_colours()) all.push_back(colour);
  for (const ClassStyle& style : run_classes()) all.push_back(style.colour);
  for (const PageColour& colour : ramp_colours()) all.push_back(colour);
  return all;
}

double contrast(const std::string& one, const std::string& other) {
  const double a = luminance(one), b = luminance(other);
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

}  // namespace cloth
