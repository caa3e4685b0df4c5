#include "kernels/lanes_sse2.h"
//
#include "kernels/grid_passes.h"

namespace cloth::kernels {

const GridKernels& sse2_grid_kernels() {
  return grid_kernels;
}

}  // namespace cloth::kernels
