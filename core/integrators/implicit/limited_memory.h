// A quasi-Newton direction from the last few changes of a residual (limited memory: Nocedal 1980, Alg. 2.1),
// with a preconditioner where the textbook has a multiple of the identity.
//
//     LimitedMemory memory;
//     memory.next(residual, 0, preconditioner, direction);         // about -(dr/dv)^-1 r
//     v += length * direction;                                     // and the residual there
//     memory.next(residual, length, preconditioner, direction);
//
// The textbook's two loops go through the fields of all pairs one after the other. Here each of four passes
// over the fields takes all pairs at once, and the loops run over products, which are numbers.
#pragma once

#include <array>
#include <cstddef>

#include "integrators/implicit/linear_solver.h"

namespace cloth {

class LimitedMemory {
 public:
  /// Drops all pairs.
  void forget() { count_ = 0; }

  /// direction = -H residual. H is symmetric and positive definite if the preconditioner is, and maps the
  /// last pair's growth to its change. `length`: how far the last direction, which `direction` still holds,
  /// led from the last residual to this one. They become a pair, in place of the oldest, where the residual
  /// has grown along that direction: only then does H stay positive definite. 0: the last direction did not
  /// lead here.
  void next(const Vec3Field& residual, double length, const LinearMap& preconditioner, Vec3Field& direction);

 private:
  static constexpr std::size_t most = 5;
  using Products = std::array<double, most + 1>;
  struct Pair {
    Vec3Field change, growth;
    double product = 0;   ///< change . growth
    Products of_older{};  ///< older pairs' changes . growth, in their order
  };

  void project(const Vec3Field& residual);
  void add_pair(const Vec3Field& residual, double length, const Vec3Field& direction);

  std::array<Pair, most + 1> pairs_;  ///< oldest first; the one after the last is being made
  std::size_t count_ = 0;
  Products projections_{};  ///< of the last residual: changes . residual
  Vec3Field last_, rest_;   ///< the last residual; scratch
};

}  // namespace cloth
