// What line plots and heat maps share: titles, captions, axes, and how values read.
#pragma once

#include <string>
#include <vector>

#include "report/axis.h"
#include "report/svg.h"

namespace cloth {

/// A rectangle of the drawing [px], y downwards.
struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

/// How many of them the box overlaps.
int covered(const Box& box, const std::vector<Box>& others);

/// The line through the points as far as it is in the box.
std::string clipped_path(const std::vector<SvgPoint>& points, const Box& box);

constexpr double tick_size = 11.5, label_size = 13, small_size = 11.5;  // of text [px]
constexpr double plot_margin = 16;                                      // around a drawing [px]

/// The height that titles take from the top of the drawing, without and with drawing them.
double titles_height(const std::string& title, const std::string& subtitle, double width);
void draw_titles(PlotCanvas& svg, const std::string& title, const std::string& subtitle, double width);

double caption_height(const std::vector<std::string>& paragraphs, double width);
void draw_caption(PlotCanvas& svg, const std::vector<std::string>& paragraphs, double top, double width);

double widest_tick(const std::vector<Tick>& ticks);

/// Grid lines, ticks and labels below the frame; the title too unless it is empty.
void draw_x_axis(PlotCanvas& svg, const AxisMap& map, const std::string& title, const Box& frame, bool grid);
/// The same on the left of the frame.
void draw_y_axis(PlotCanvas& svg, const AxisMap& map, const std::string& title, const Box& frame, bool grid);

/// "run time: 0.0123 s"
std::string value_line(const Axis& axis, double value);

constexpr double x_tick_spacing = 64, y_tick_spacing = 26;  // between labels [px]

}  // namespace cloth
