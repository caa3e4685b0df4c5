#include "kernels/lanes_avx2.h"
//
#include "kernels/grid_passes.h"

namespace cloth::kernels {

const GridKernels& avx2_grid_kernels() {
  return grid_kernels;
}

}  // namespace cloth::kernels
