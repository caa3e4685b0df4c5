// Where slope triangles go: off the data where there is room.
#pragma once

#include <vector>

#include "report/line_plot.h"
#include "report/plot_parts.h"

namespace cloth {

struct PlacedTriangle {
  SvgPoint corner;     // the right angle
  SvgPoint along, up;  // the ends of its horizontal and vertical leg
  SvgPoint label;      // baseline of the label, left aligned
  std::string text;
};

/// `occupied`: boxes to keep off. A triangle with no free place goes where it covers least.
std::vector<PlacedTriangle> place_triangles(const std::vector<SlopeTriangle>& triangles, const AxisMap& x,
                                            const AxisMap& y, const Box& frame, std::vector<Box> occupied);

}  // namespace cloth
