// Writes SVG: numbers without locale, text escaped, colours that a page can turn dark.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/palette.h"

namespace cloth {

/// At most two decimals, no exponent, no "-0"; 0 for what is not finite, so that a drawing is always valid.
std::string svg_number(double value);

/// A number for people: `digits` significant ones, "2.5e-06"; "not finite" for infinity and NaN.
std::string short_number(double value, int digits = 4);

/// & < > " ' escaped; bytes that are no UTF-8 and characters that XML forbids become U+FFFD.
std::string xml_escaped(std::string_view text);

/// Width of a text in a face with the measures of Helvetica [px]. An estimate, somewhat generous.
double text_width(std::string_view text, double size, bool bold = false);

/// Lines no wider than `width`, broken at spaces; a longer word keeps a line of its own.
std::vector<std::string> wrapped(const std::string& text, double size, double width);

struct SvgPoint {
  double x = 0, y = 0;
};

struct SvgStyle {
  std::optional<PageColour> fill{}, stroke{};
  double stroke_width = 1;
  Dash dash = Dash::solid;
  double opacity = 1;
};

enum class Anchor { start, middle, end };

struct SvgText {
  std::string text{};
  double size = 12;
  Anchor anchor = Anchor::start;
  bool bold = false;
  PageColour colour = page_colours().ink;
  double turn = 0;            // degrees, clockwise
  std::string superscript{};  // behind the text
  bool halo = false;          // a rim of the paper's colour, for text over lines
};

/// "M1 2L3 4", with "Z" where closed.
std::string path_through(const std::vector<SvgPoint>& points, bool closed = false);

/// Outline of a marker that fills about the circle of this radius; plus and cross are strokes only.
std::string marker_path(Marker marker, SvgPoint centre, double radius);
bool is_stroke_only(Marker marker);

/// What the pointer finds at a shape: lines of text, and the plot's own number for what is drawn there.
struct SvgTip {
  SvgTip() = default;
  SvgTip(std::string lines, int number = -1) : text(std::move(lines)), tag(number) {}
  SvgTip(const char* lines) : text(lines) {}
  std::string text{};
  int tag = -1;  ///< -1: none
};

/// What plots are drawn on: an SVG document here, the painter of a window elsewhere. Coordinates in px, y
/// downwards.
class PlotCanvas {
 public:
  virtual ~PlotCanvas() = default;
  /// `data` as path_through and marker_path write it.
  virtual void path(const std::string& data, const SvgStyle& style, const SvgTip& tip = {}) = 0;
  virtual void rect(SvgPoint corner, double width, double height, const SvgStyle& style,
                    const SvgTip& tip = {}) = 0;
  virtual void text(SvgPoint baseline, const SvgText& text) = 0;
  virtual void marker(Marker marker, SvgPoint centre, double radius, const SvgStyle& style,
                      const SvgTip& tip = {}) = 0;

  /// The style holds for what is inside unless that has its own. `untouchable`: the pointer goes through it.
  /// `crisp`: no soft edges, so that neighbours join without a seam.
  virtual void begin_group(const std::string& name, const SvgStyle& style = {}, bool untouchable = false,
                           bool crisp = false) = 0;
  virtual void end_group() = 0;

  void line(SvgPoint from, SvgPoint to, const SvgStyle& style) { path(path_through({from, to}), style); }
};

class SvgWriter : public PlotCanvas {
 public:
  /// `description` tells what the drawing shows to who cannot see it.
  SvgWriter(double width, double height, const std::string& description);

  void path(const std::string& data, const SvgStyle& style, const SvgTip& tip = {}) override;
  void rect(SvgPoint corner, double width, double height, const SvgStyle& style,
            const SvgTip& tip = {}) override;
  void text(SvgPoint baseline, const SvgText& text) override;
  void marker(Marker marker, SvgPoint centre, double radius, const SvgStyle& style,
              const SvgTip& tip = {}) override;
  void begin_group(const std::string& name, const SvgStyle& style = {}, bool untouchable = false,
                   bool crisp = false) override;
  void end_group() override;

  /// The document. Groups must be closed.
  std::string finish();

 private:
  void element(std::string_view name, const std::string& attributes, const std::string& tooltip);

  std::string out_;
  int depth_ = 0;
};

/// A complete SVG document that needs nothing else: of a LinePlot, a HeatMap or a CategoryMap. The same text
/// for the same plot.
template <class Plot>
std::string to_svg(const Plot& plot) {
  SvgWriter svg(plot.width, height_of(plot), plot.title.empty() ? "Plot" : plot.title);
  draw(svg, plot);
  return svg.finish();
}

}  // namespace cloth
