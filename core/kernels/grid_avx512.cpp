#include "kernels/lanes_avx512.h"
//
#include "kernels/grid_passes.h"

namespace cloth::kernels {

const GridKernels& avx512_grid_kernels() {
  return grid_kernels;
}

}  // namespace cloth::kernels
