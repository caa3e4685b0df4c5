// The shapes of heavy strips by which textile laboratories measure bending, each a planar inextensible
// elastica with its own ends. Peirce 1930 has the loops, Plaut 2015 lists nine such tests: these and the
// cantilever (heavy_strip.h). The equations of all are those of elastica.h; what is said here is each test's
// ends.
//
// Gamma = mu g L^3/B >= 0, and lengths are in L, which every function says. Empty: the strip would touch
// itself, which these equations do not know, or no solution was found from the weightless shape on (loops:
// beyond a Gamma of some 10000, the hanging wrinkle: 6000). Contact is without friction. Heights and widths
// are good to six digits.
//
//     pear_loop(20)->drop   // from the clamp to the lowest point, over the strip's length
#pragma once

#include <optional>
#include <vector>

#include "exact/elastica.h"

namespace cloth::exact {

struct StripShape {
  std::vector<ElasticaPoint> points;  ///< at even arcs; a part that lies flat has its ends alone
  bool is_half = false;               ///< the other half is its mirror image
  double height = 0, width = 0;       ///< extent of the whole
  double drop = 0;                    ///< of the last point below the first; negative: above
  double resting = 0;                 ///< how much of the strip lies flat, both halves
  ElasticaLoad load;                  ///< at the first point that does not lie flat
};

/// Hangs from a clamp that holds both ends, which lead straight up; a half turns down to the lowest point. L:
/// the length between the ends.
std::optional<StripShape> heart_loop(double gamma);
/// The same with ends that lead straight down.
std::optional<StripShape> pear_loop(double gamma);
/// Closed to a ring and hung up at a point, where it goes on smoothly. L: circumference.
std::optional<StripShape> hanging_ring(double gamma);
/// The ring on a floor: touches it at a point as long as it is bent there, then along a flat part of
/// `resting`, at whose ends the curvature is zero. L: circumference.
std::optional<StripShape> standing_ring(double gamma);

/// A strip folded back over itself on a floor, both layers lying flat far from the fold: lifts off and comes
/// down without curvature. No L: lengths are in the bending length (B/(mu g))^(1/3), that is Gamma = 1.
std::optional<StripShape> free_fold();
/// The same with the upper end clamped, flat, on the lower end, which lies on the floor: an unknown part lies
/// flat first. From Gamma = clamped_fold_limit() on the upper layer lies flat, too: the free fold. L: both
/// layers.
std::optional<StripShape> clamped_fold(double gamma);
double clamped_fold_limit();

/// A wrinkle pushed together on a floor: lifts off and comes down without curvature (Vella et al. 2009). L:
/// the length off the floor. The half from the floor to the top. Gamma > 0.
std::optional<StripShape> standing_wrinkle(double gamma);
/// A strip between two horizontal clamps of one height, span L apart, 0 < span < 1; sags. The left half. L:
/// the length between the clamps.
std::optional<StripShape> hanging_wrinkle(double gamma, double span);

/// The stick-slip test (Sano et al. 2017; Romero et al. 2021). Weightless strip clamped perpendicularly to a
/// plane, pressed on it by eps L, with its tip where it first touched and free to turn: the forces of the
/// tip, in B/L^2. L: its length. 0 < eps <= 0.5.
struct PressedStrip {
  double normal = 0, tangential = 0;  ///< N -> 20.19 as eps -> 0
  double friction = 0;                ///< |T/N|: with less the tip slips
  std::vector<ElasticaPoint> points;  ///< from the clamp downwards to the tip
};
std::optional<PressedStrip> pressed_strip(double eps);

}  // namespace cloth::exact
