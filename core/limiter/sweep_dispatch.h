// Which of the compiled kernels this processor runs.
#pragma once

#include <vector>

#include "limiter/sweep_kernels.h"

namespace cloth {

/// The best that this processor has.
const SweepKernels& sweep_kernels();

/// All that this processor has, the plain one first and the best last.
const std::vector<const SweepKernels*>& all_sweep_kernels();

}  // namespace cloth
