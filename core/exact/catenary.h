// An inextensible heavy cloth without bending stiffness between two level lines at any heights: the catenary
// (Irvine 1981).
#pragma once

#include <vector>

#include "exact/elastica.h"

namespace cloth::exact {

struct Catenary {
  double parameter = 0;               ///< a of y = a cosh((x - x_0)/a), m: horizontal tension over mu g
  double lowest_x = 0, lowest_y = 0;  ///< of the whole curve, m: may lie outside the supports
  double sag = 0;                     ///< most that the cloth is below the line between its supports, m
  double horizontal = 0;              ///< tension's horizontal part, the same everywhere, N/m
  double left_tension = 0, right_tension = 0;  ///< at the supports, along the cloth, N/m
  std::vector<ElasticaPoint> points;           ///< from the left support at (0, 0) in even arcs; m, rad, 1/m
};

/// `length` (m) of cloth, more than the supports' distance; the right one is `span` > 0 (m) beside the left
/// one and `rise` (m) above it. Areal density kg/m2, gravity m/s2.
Catenary catenary(double length, double span, double rise, double areal_density, double gravity,
                  int steps = 200);

}  // namespace cloth::exact
