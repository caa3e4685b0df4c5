// VBD's visits of a grid of springs (grid_visits.h). In a row the columns 0, 5, 10, ... come first, then 1,
// 6,
// ... and so on, each such run padded to whole registers and some beyond.
#pragma once

#include "kernels/grid_pass.h"
#include "kernels/particle_descent.h"

namespace cloth {

class GridDescent : public ParticleDescent {
 public:
  /// Precondition: suits(grid).
  explicit GridDescent(const kernels::Grid& grid);
  static bool suits(const kernels::Grid& grid);
  bool takes_elements() const override { return false; }

 private:
  void begin_visits(const Start&) override {}
  void visit_all() override { kernels_->descend(descent_); }

  kernels::Descent descent_;
  const kernels::GridKernels* kernels_;
  AlignedDoubles there_;
};

}  // namespace cloth
