// A strip of a material beside an exact curve: its scene, its start on that curve, and what its rest has.
#pragma once

#include <vector>

#include "exact/elastica.h"
#include "scene/scene.h"
#include "simulation/rest_shape.h"
#include "study/study_progress.h"

namespace cloth {

/// How an end of a strip is held.
enum class StripEnd { free, pinned, clamped };

/// The curve of the whole strip, arcs from 0 to 1, lengths in the strip's own.
struct StripCurve {
  std::vector<exact::ElasticaPoint> points;
  StripEnd first = StripEnd::clamped, last = StripEnd::free;
};

/// The mirror image of a half is put behind it.
StripCurve whole_curve(const std::vector<exact::ElasticaPoint>& half, StripEnd ends);

/// x and y on the curve at an arc, in the strip's length; beyond a clamp straight on.
Eigen::Vector2d point_at(const StripCurve& curve, double arc);

/// In the strip's length.
using PlanePoints = std::vector<Eigen::Vector2d>;

/// What a strip is made and loaded like. Its length is 0.1 m, its width that of two cells.
struct StripCase {
  double load = 0;       ///< Gamma = mu g L^3/B; gravity points along -y
  bool bends = true;     ///< false: mu g L takes the place of B/L^2
  double stretch = 1e8;  ///< over B/L^2
  int cells = 20, across = 2;
};

/// A grid of `cells` along the strip, and one more behind every clamp.
Scene strip_scene(const StripCase& of, const StripCurve& curve);

/// Its particles on the curve, and straight on behind clamps; m. `system` is make_cloth(strip_scene).
Vec3Field start_of_strip(const StripCase& of, const StripCurve& curve, const ClothSystem& system);

/// The rest that is found from the exact curve on; points of its middle row from the first end to the last,
/// in the strip's length.
struct StripRest {
  RestShape rest;
  std::vector<Eigen::Vector2d> points;
};
StripRest rest_of_strip(const StripCase& of, const StripCurve& curve, const StopTest& stop = {});

inline constexpr double strip_length = 0.1, standard_gravity = 9.81;  // m, m/s^2

}  // namespace cloth
