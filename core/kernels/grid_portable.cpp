#include "kernels/lanes_portable.h"
//
#include "kernels/grid_passes.h"

namespace cloth::kernels {

const GridKernels& portable_grid_kernels() {
  return grid_kernels;
}

}  // namespace cloth::kernels
