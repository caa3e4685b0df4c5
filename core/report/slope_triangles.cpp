#include <algorithm>
#include <cmath>
#include <limits>

#include "report/line_plot_layout.h"

namespace cloth {
namespace {

constexpr double widest = 56, tallest = 76, gap = 8;  // [px]
constexpr double raster = 8;                          // between two tried places [px]

struct Sides {
  std::string text;
  double width = 0, height = 0, label_width = 0;
  bool falling = false;
  double whole_width() const { return width + label_width + gap; }
};

std::vector<Sides> shapes_of(const std::vector<SlopeTriangle>& triangles, const AxisMap& x,
                             const AxisMap& y) {
  std::vector<Sides> shapes;
  for (const SlopeTriangle& triangle : triangles) {
    if (!std::isfinite(triangle.slope) || triangle.slope == 0) continue;
    const std::string text = triangle.label.empty() ? short_number(std::abs(triangle.slope)) : triangle.label;
    const double steepness = std::abs(triangle.slope) * y.density() / x.density();
    Sides shape{text, widest, widest * steepness, text_width(text, small_size), triangle.slope < 0};
    if (shape.height > tallest) shape.width = tallest / steepness, shape.height = tallest;
    shapes.push_back(shape);
  }
  return shapes;
}

/// The corner of the frame that the data leaves most room in.
SvgPoint emptiest_corner(const Box& frame, const std::vector<Box>& occupied) {
  SvgPoint best{frame.left, frame.bottom};
  int fewest = std::numeric_limits<int>::max();
  for (const SvgPoint corner : {SvgPoint{frame.left, frame.bottom}, SvgPoint{frame.right, frame.top},
                                SvgPoint{frame.right, frame.bottom}, SvgPoint{frame.left, frame.top}}) {
    const double w = 0.4 * frame.width(), h = 0.4 * frame.height();
    const int count = covered({corner.x - w, corner.y - h, corner.x + w, corner.y + h}, occupied);
    if (count < fewest) fewest = count, best = corner;
  }
  return best;
}

struct Place {
  SvgPoint at;  // upper left corner
  int overlaps = 0;
};

/// The least crowded, then nearest place to the corner for a box of this size.
Place best_place(double width, double height, const Box& frame, const std::vector<Box>& occupied,
                 SvgPoint corner) {
  Place best{{frame.left + gap, frame.top + gap}, std::numeric_limits<int>::max()};
  double least = std::numeric_limits<double>::infinity();
  for (double left = frame.left + gap; left + width + gap <= frame.right; left += raster)
    for (double top = frame.top + gap; top + height + gap <= frame.bottom; top += raster) {
      const int overlaps = covered({left - gap, top - gap, left + width + gap, top + height + gap}, occupied);
      const double distance = std::hypot((left + width / 2 - corner.x) / frame.width(),
                                         (top + height / 2 - corner.y) / frame.height());
      if (10 * overlaps + distance < least) least = 10 * overlaps + distance, best = {{left, top}, overlaps};
    }
  return best;
}

/// In a box whose upper left corner this is, with `label_width` for the labels on a falling triangle's left.
PlacedTriangle placed(const Sides& shape, SvgPoint at, double label_width) {
  const double left = shape.falling ? at.x + gap + label_width : at.x;
  const double right = left + shape.width, bottom = at.y + shape.height;
  // The legs meet below the line where it rises, and left below it where it falls.
  PlacedTriangle triangle;
  triangle.text = shape.text;
  triangle.corner = {shape.falling ? left : right, bottom};
  triangle.along = {shape.falling ? right : left, bottom};
  triangle.up = {triangle.corner.x, at.y};
  triangle.label = {shape.falling ? left - gap - shape.label_width : right + gap, (at.y + bottom) / 2 + 4};
  return triangle;
}

}  // namespace

std::vector<PlacedTriangle> place_triangles(const std::vector<SlopeTriangle>& triangles, const AxisMap& x,
                                            const AxisMap& y, const Box& frame, std::vector<Box> occupied) {
  std::vector<PlacedTriangle> result;
  if (x.scale() != AxisScale::logarithmic || y.scale() != AxisScale::logarithmic) return result;
  const std::vector<Sides> shapes = shapes_of(triangles, x, y);
  if (shapes.empty()) return result;
  const SvgPoint corner = emptiest_corner(frame, occupied);

  // Together if there is room: above each other, else side by side.
  double column_width = 0, column_height = -2 * gap, row_width = -2 * gap, row_height = 0, labels = 0;
  for (const Sides& shape : shapes) {
    labels = std::max(labels, shape.label_width);
    column_width = std::max(column_width, shape.width);
    column_height += shape.height + 2 * gap, row_height = std::max(row_height, shape.height);
    row_width += shape.whole_width() + 2 * gap;
  }
  const Place column = best_place(column_width + gap + labels, column_height, frame, occupied, corner);
  if (column.overlaps == 0) {
    double top = column.at.y;
    for (const Sides& shape : shapes) {
      result.push_back(placed(shape, {column.at.x, top}, labels));
      top += shape.height + 2 * gap;
    }
    return result;
  }
  const Place row = best_place(row_width, row_height, frame, occupied, corner);
  if (row.overlaps == 0) {
    double left = row.at.x;
    for (const Sides& shape : shapes) {
      result.push_back(placed(shape, {left, row.at.y + row_height - shape.height}, shape.label_width));
      left += shape.whole_width() + 2 * gap;
    }
    return result;
  }
  for (const Sides& shape : shapes) {
    const SvgPoint at = best_place(shape.whole_width(), shape.height, frame, occupied, corner).at;
    occupied.push_back({at.x, at.y, at.x + shape.whole_width(), at.y + shape.height});
    result.push_back(placed(shape, at, shape.label_width));
  }
  return result;
}

}  // namespace cloth
