// Accelerations of the iteration v <- v - e of a quasi-Newton method, e = B r(v), r the residual of its
// equations and B a constant, symmetric, positive matrix. All keep its limit, the solution of r(v) = 0.
#pragma once

#include <memory>
#include <string>

#include "geometry/vec3_field.h"

namespace cloth {

/// What an iteration knows.
struct Iterate {
  const Vec3Field& v;  ///< m/s
  const Vec3Field& r;  ///< N s, zero on pins
  const Vec3Field& e;  ///< B r, m/s
  double merit = 0;    ///< r . e, J: zero at the solution alone
};

class Acceleration {
 public:
  virtual ~Acceleration() = default;
  /// Computes the next v from the present iterate and those since restart(). Returns whether it differs from
  /// v - e.
  virtual bool propose(const Iterate& now, Vec3Field& next) = 0;
  /// Forgets all iterates: at the beginning of a step, and where a proposal was worse than the iterate that
  /// it came from.
  virtual void restart() = 0;
};

/// "chebyshev" (Wang 2015), with the spectral radius that two plain iterations show; "anderson" (Anderson
/// 1965; Peng et al. 2018), "l-bfgs" (Liu et al. 2017), both with the last five iterates; null for "none".
std::unique_ptr<Acceleration> make_acceleration(const std::string& name);

}  // namespace cloth
