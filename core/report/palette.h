// Colours, markers and dashes of plots and reports: safe for colour-blind readers, on white and on near-black
// paper.
#pragma once

#include <string>
#include <vector>

namespace cloth {

/// One colour in both schemes. A drawing carries the light one; a page turns to the dark one by `name`,
/// which is unique, lower case letters and digits only. Values are "#rrggbb".
struct PageColour {
  std::string name{};
  std::string light{};
  std::string dark{};
};

enum class Marker {
  circle,
  square,
  triangle_up,
  diamond,
  triangle_down,
  cross,
  pentagon,
  plus,
  star,
  hexagon
};
enum class Dash { solid, dashed, dotted, dash_dotted };

struct SeriesStyle {
  PageColour colour{};
  Marker marker = Marker::circle;
  Dash dash = Dash::solid;
};

/// The style of series 0, 1, 2, ...: the first 40 differ in (colour, marker), the first 160 in all three.
/// Hues after Okabe and Ito (2008), darker on white and lighter on black where theirs lack contrast.
SeriesStyle style_of_series(int index);

/// What a map of stability says of a run.
enum class RunClass { accurate, stable_but_inaccurate, energy_growth, diverged, solver_failed };

/// The mark in a cell's middle that makes a class readable without colour.
enum class CellMark { none, dot, slash, cross, ring };

struct ClassStyle {
  std::string name{};  // as legends and tables say it
  PageColour colour{};
  CellMark mark = CellMark::none;
};

/// The five classes in the order of RunClass.
const std::vector<ClassStyle>& run_classes();

/// Paper and ink.
struct PageColours {
  PageColour surface{};  // behind everything
  PageColour ink{};      // text and axes
  PageColour muted{};    // captions, tick labels
  PageColour grid{};     // grid lines
  PageColour band{};     // areas that are out of reach, such as a floor
};
const PageColours& page_colours();

/// Every colour there is, for a page's style sheet.
std::vector<PageColour> all_colours();

/// Contrast of two "#rrggbb" colours, 1 to 21 (WCAG 2.1).
double contrast(const std::string& one, const std::string& other);

}  // namespace cloth
