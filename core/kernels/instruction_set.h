// Which of the compiled instruction sets the kernels use. One binary holds all of them; the choice is made at
// run time: the best that the processor has, or what CLOTHLAB_INSTRUCTION_SET or a caller asks for.
//
// Two runs on the same set agree to the last bit, on whatever machine and with any number of threads. Sets
// differ by rounding: `portable` rounds every product and sum, `avx2` and `avx512` fuse them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/kernel_table.h"

namespace cloth {

enum class InstructionSet { portable, avx2, avx512 };  // portable: SSE2 on x86-64

inline constexpr const char* instruction_set_variable = "CLOTHLAB_INSTRUCTION_SET";

const char* name_of(InstructionSet set);
std::optional<InstructionSet> instruction_set_named(std::string_view name);

/// Those that this binary and this processor have, from `portable` up. Never empty.
const std::vector<InstructionSet>& supported_instruction_sets();

/// What is wrong with the value of the environment variable, in one line; empty if nothing is.
std::string instruction_set_problem();

/// The set that everything made from now on uses: force models, limiters, solvers. The best, where the
/// environment variable names one that is not supported.
InstructionSet active_instruction_set();

/// Overrides the environment; nullopt gives it back. For tests and benchmarks. Precondition: supported.
void set_instruction_set(std::optional<InstructionSet> set);

/// The table of the active set, see kernel_table.h.
template <class Kernels>
const Kernels& active_kernels() {
  switch (active_instruction_set()) {
#ifdef CLOTHLAB_X86_KERNELS
    case InstructionSet::avx2:
      return Kernels::avx2();
    case InstructionSet::avx512:
      return Kernels::avx512();
#endif
    default:
      return Kernels::portable();
  }
}

}  // namespace cloth
