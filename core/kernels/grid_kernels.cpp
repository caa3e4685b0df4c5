// A kernel source, see kernel_table.h.
#include CLOTHLAB_LANES
//
#include "kernels/grid_passes.h"

namespace cloth::kernels {

const GridKernels& GridKernels::CLOTHLAB_SET() {
  return grid_kernels;
}

}  // namespace cloth::kernels
