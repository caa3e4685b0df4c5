// A quasi-Newton direction from the last few changes of a residual (limited memory: Nocedal 1980, Alg. 2.1),
// with a preconditioner where the textbook has a multiple of the identity.
//
//     LimitedMemory memory;
//     memory.forget();
//     memory.direction(residual, preconditioner, direction);   // about -(dr/dv)^-1 r
//     memory.add(change of v, change of r);
#pragma once

#include <deque>

#include "integrators/implicit/linear_solver.h"

namespace cloth {

class LimitedMemory {
 public:
  /// Drops all pairs.
  void forget() { pairs_.clear(); }

  /// Keeps the pair in place of the oldest where the residual has grown along the change: only then does the
  /// estimate stay positive definite.
  void add(Vec3Field change, Vec3Field growth);

  /// direction = -H residual. H is symmetric and positive definite if the preconditioner is, and maps the
  /// last pair's growth to its change.
  void direction(const Vec3Field& residual, const LinearMap& preconditioner, Vec3Field& direction);

 private:
  static constexpr std::size_t most = 8;
  struct Pair {
    Vec3Field change, growth;
    double product = 0;  ///< change . growth
    double weight = 0;   ///< scratch
  };

  std::deque<Pair> pairs_;  ///< oldest first
  Vec3Field rest_;
};

}  // namespace cloth
