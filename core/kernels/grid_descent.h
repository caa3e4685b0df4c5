// The storage of VBD's visits of a grid of springs (grid_visits.h), and what calls them. A step is
//
//     descent.begin(...); sweep(), and extrapolate() between two sweeps, as often as wanted;
//     descent.end(velocity)
//
// In a row the columns 0, 5, 10, ... come first, then 1, 6, ... and so on, each such run padded to whole
// registers and some beyond. Threads do not share the work.
#pragma once

#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "geometry/aligned.h"
#include "kernels/grid_pass.h"

namespace cloth {

class GridDescent {
 public:
  /// Precondition: suits(grid).
  explicit GridDescent(const kernels::Grid& grid);
  static bool suits(const kernels::Grid& grid);

  /// A step of `step` s from `start` (m), with inertia `mass` (kg, W^-1 of integrators/vbd.h; 0 where pinned)
  /// about the velocities `predicted` (m/s), where it begins. `spring_damping` in N s/m. `extrapolates`:
  /// whether extrapolate() may be called.
  void begin(double step, const std::vector<double>& mass, double spring_damping, const Vec3Field& start,
             const Vec3Field& predicted, bool extrapolates);

  struct Sums {
    double change = 0;   ///< the largest, squared, of a particle's velocity by a visit, (m/s)^2
    double squares = 0;  ///< their sum
  };
  Sums sweep();
  void extrapolate(double weight);
  /// Adds what particles have moved over the step's length to the predicted velocities.
  void end(Vec3Field& velocity) const;

 private:
  using Stored = std::array<AlignedDoubles, 3>;
  template <class Visit>
  void for_each_particle(const Visit& visit) const;
  void store(const Vec3Field& field, Stored& to) const;

  kernels::Descent descent_;
  const kernels::GridKernels* kernels_;
  Stored position_, shift_, start_, before_, present_;
  AlignedDoubles mass_, free_, there_;
  double step_ = 0;
};

}  // namespace cloth
