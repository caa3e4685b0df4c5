#include "study/validation/strip.h"

#include <algorithm>
#include <cmath>

#include "scene/scene_cloth.h"

namespace cloth {
namespace {

using Eigen::Vector2d;

constexpr double density = 0.2;  // kg/m^2

/// Columns behind the end.
int behind(StripEnd end) {
  return end == StripEnd::clamped ? 1 : 0;
}

Vector2d at(const exact::ElasticaPoint& point) {
  return {point.x, point.y};
}

}  // namespace

StripCurve whole_curve(const std::vector<exact::ElasticaPoint>& half, StripEnd ends) {
  StripCurve curve{half, ends, ends};
  const exact::ElasticaPoint middle = half.back();
  for (exact::ElasticaPoint& point : curve.points) point.arc *= 0.5 / middle.arc;
  for (std::size_t k = half.size() - 1; k-- > 0;) {
    exact::ElasticaPoint mirrored = curve.points[k];
    mirrored.arc = 1 - mirrored.arc;
    mirrored.x = 2 * middle.x - mirrored.x;
    mirrored.angle = exact::upward - mirrored.angle;
    curve.points.push_back(mirrored);
  }
  return curve;
}

Vector2d point_at(const StripCurve& curve, double arc) {
  const auto& points = curve.points;
  const auto straight_on = [&](const exact::ElasticaPoint& end) -> Vector2d {
    return at(end) + (arc - end.arc) * Vector2d(std::sin(end.angle), -std::cos(end.angle));
  };
  if (arc <= points.front().arc) return straight_on(points.front());
  if (arc >= points.back().arc) return straight_on(points.back());
  const auto above = std::lower_bound(points.begin() + 1, points.end() - 1, arc,
                                      [](const exact::ElasticaPoint& p, double s) { return p.arc < s; });
  const exact::ElasticaPoint &from = *(above - 1), &to = *above;
  const double part = (arc - from.arc) / (to.arc - from.arc);
  return at(from) + part * (at(to) - at(from));
}

Scene strip_scene(const StripCase& of, const StripCurve& curve) {
  const int first = behind(curve.first), last = behind(curve.last);
  Scene scene;
  ClothSheet& cloth = scene.cloth;
  const double cell = strip_length / of.cells;
  cloth.columns = of.cells + 1 + first + last, cloth.rows = of.across + 1;
  cloth.width = cell * (cloth.columns - 1), cloth.height = cell * of.across;
  cloth.origin = {-cell * first, 0, 0};
  cloth.across = {1, 0, 0}, cloth.down = {0, 0, 1};
  const auto pin = [&](StripEnd end, int column, int inwards) {
    if (end == StripEnd::free) return;
    for (int row = 0; row < cloth.rows; ++row) {
      cloth.pins.emplace_back(PinnedParticle{row, column});
      if (end == StripEnd::clamped) cloth.pins.emplace_back(PinnedParticle{row, column + inwards});
    }
  };
  pin(curve.first, 0, 1);
  pin(curve.last, cloth.columns - 1, -1);
  scene.gravity = Vec3(0, -standard_gravity, 0);
  const double weight = density * standard_gravity * strip_length;  // N/m
  const double bending = weight * strip_length * strip_length / of.load;
  const double stiff = of.stretch * (of.bends ? bending / (strip_length * strip_length) : weight);
  scene.material =
      Material{.areal_density = density, .stretch_warp = stiff, .stretch_weft = stiff, .shear = stiff / 10};
  if (of.bends) scene.material->bending_warp = scene.material->bending_weft = scene.material->twist = bending;
  return scene;
}

Vec3Field start_of_strip(const StripCase& of, const StripCurve& curve, const ClothSystem& system) {
  Vec3Field position(system.start.size());
  for (int row = 0; row < system.rows; ++row)
    for (int column = 0; column < system.columns; ++column) {
      const double arc = static_cast<double>(column - behind(curve.first)) / of.cells;
      const Vector2d here = strip_length * point_at(curve, arc);
      position.set(static_cast<std::size_t>(system.index(row, column)),
                   {here.x(), here.y(), strip_length * row / of.cells});
    }
  return position;
}

StripRest rest_of_strip(const StripCase& of, const StripCurve& curve, const StopTest& stop) {
  const Scene scene = strip_scene(of, curve);
  const ClothSystem system = make_cloth(scene);
  StripRest found{find_rest(scene, system, start_of_strip(of, curve, system), {.stop = stop}), {}};
  for (int k = 0; k <= of.cells; ++k) {
    const int i = system.index(of.across / 2, k + behind(curve.first));
    const Vec3 x = found.rest.position[static_cast<std::size_t>(i)] / strip_length;
    found.points.emplace_back(x.x(), x.y());
  }
  return found;
}

}  // namespace cloth
