#include "report/slope_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

constexpr double widest = 56, tallest = 76, gap = 6;  // [px]
constexpr double grid = 8;                            // between two tried places [px]

struct Shape {
  double width = 0, height = 0, label_width = 0;
  bool falling = false;
};

Shape shape_of(const SlopeTriangle& triangle, const std::string& text, const AxisMap& x, const AxisMap& y) {
  const double steepness = std::abs(triangle.slope) * y.density() / x.density();
  Shape shape{widest, widest * steepness, text_width(text, small_size), triangle.slope < 0};
  if (shape.height > tallest) shape.width = tallest / steepness, shape.height = tallest;
  return shape;
}

double covered(const Box& box, const std::vector<Box>& occupied) {
  double count = 0;
  for (const Box& other : occupied) count += box.overlaps(other) ? 1 : 0;
  return count;
}

/// The corner of the frame that the data leaves most room in.
SvgPoint emptiest_corner(const Box& frame, const std::vector<Box>& occupied) {
  SvgPoint best{frame.left, frame.bottom};
  double fewest = std::numeric_limits<double>::infinity();
  for (const SvgPoint corner : {SvgPoint{frame.left, frame.bottom}, SvgPoint{frame.right, frame.top},
                                SvgPoint{frame.right, frame.bottom}, SvgPoint{frame.left, frame.top}}) {
    const double w = 0.4 * frame.width(), h = 0.4 * frame.height();
    const double count = covered({corner.x - w, corner.y - h, corner.x + w, corner.y + h}, occupied);
    if (count < fewest) fewest = count, best = corner;
  }
  return best;
}

/// The box of triangle and label with its least crowded, then nearest place to the corner.
Box best_box(const Shape& shape, const Box& frame, const std::vector<Box>& occupied, SvgPoint corner) {
  const double width = shape.width + shape.label_width + 2 * gap, height = shape.height + gap;
  Box best{frame.left + gap, frame.top + gap, frame.left + gap + width, frame.top + gap + height};
  double least = std::numeric_limits<double>::infinity();
  for (double left = frame.left + gap; left + width + gap <= frame.right; left += grid)
    for (double top = frame.top + gap; top + height + gap <= frame.bottom; top += grid) {
      const Box box{left, top, left + width, top + height};
      const double distance = std::hypot((left + width / 2 - corner.x) / frame.width(),
                                         (top + height / 2 - corner.y) / frame.height());
      const double cost =
          10 * covered({box.left - gap, box.top - gap, box.right + gap, box.bottom + gap}, occupied) +
          distance;
      if (cost < least) least = cost, best = box;
    }
  return best;
}

}  // namespace

std::vector<PlacedTriangle> place_triangles(const std::vector<SlopeTriangle>& triangles, const AxisMap& x,
                                            const AxisMap& y, const Box& frame, std::vector<Box> occupied) {
  std::vector<PlacedTriangle> placed;
  if (x.scale() != AxisScale::logarithmic || y.scale() != AxisScale::logarithmic) return placed;
  const SvgPoint corner = emptiest_corner(frame, occupied);
  for (const SlopeTriangle& triangle : triangles) {
    if (!std::isfinite(triangle.slope) || triangle.slope == 0) continue;
    const std::string text = triangle.label.empty() ? short_number(std::abs(triangle.slope)) : triangle.label;
    const Shape shape = shape_of(triangle, text, x, y);
    const Box box = best_box(shape, frame, occupied, corner);
    occupied.push_back(box);
    // The legs meet below the line where it rises and left below it where it falls.
    const double left = shape.falling ? box.left + gap + shape.label_width : box.left;
    const double right = left + shape.width, top = box.top, bottom = box.top + shape.height;
    PlacedTriangle one;
    one.text = text;
    one.corner = {shape.falling ? left : right, bottom};
    one.along = {shape.falling ? right : left, bottom};
    one.up = {one.corner.x, top};
    one.label = {shape.falling ? box.left : right + gap, (top + bottom) / 2 + 4};
    placed.push_back(one);
  }
  return placed;
}

}  // namespace cloth
