#include "limiter/sweep_dispatch.h"

#include <algorithm>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

std::vector<const SweepKernels*> usable_kernels() {
  std::vector<const SweepKernels*> usable{plain_sweep_kernels()};
#if defined(__x86_64__)
  const auto add = [&](const SweepKernels* kernels, bool supported) {
    if (kernels && supported) usable.push_back(kernels);
  };
  add(sse2_sweep_kernels(), true);  // part of every x86-64
  add(avx2_sweep_kernels(), __builtin_cpu_supports("avx2"));
  add(avx512_sweep_kernels(), __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"));
#endif
  return usable;
}

}  // namespace

const std::vector<const SweepKernels*>& all_sweep_kernels() {
  static const std::vector<const SweepKernels*> kernels = usable_kernels();
  return kernels;
}

const SweepKernels& sweep_kernels() {
  const std::vector<const SweepKernels*>& kernels = all_sweep_kernels();
  return **std::find_if(kernels.rbegin(), kernels.rend(),
                        [](const SweepKernels* kernel) { return may_run(kernel->instruction_set); });
}

}  // namespace cloth
