#include "limiter/sweep_kernel_body.h"

namespace cloth {

const SweepKernels* plain_sweep_kernels() {
  static constexpr SweepKernels kernels = kernels_of<OneLane>("plain");
  return &kernels;
}

}  // namespace cloth
