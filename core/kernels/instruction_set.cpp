#include "kernels/instruction_set.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstdlib>

namespace cloth {
namespace {

constexpr std::array all_sets{InstructionSet::portable, InstructionSet::sse2, InstructionSet::avx2,
                              InstructionSet::avx512};
constexpr int no_override = -1;
std::atomic<int> override_value = no_override;

bool has(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return true;
#ifdef CLOTHLAB_X86_KERNELS
    case InstructionSet::sse2:
      return true;  // part of x86-64
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl");
#endif
    default:
      return false;
  }
}

bool is_supported(InstructionSet set) {
  const auto& sets = supported_instruction_sets();
  return std::find(sets.begin(), sets.end(), set) != sets.end();
}

/// Read once: a change of the environment while the program runs has no effect.
const std::string& requested_name() {
  static const std::string text = [] {
    const char* value = std::getenv(instruction_set_variable);
    return std::string(value ? value : "");
  }();
  return text;
}

std::string names_of(const std::vector<InstructionSet>& sets) {
  std::string text;
  for (const InstructionSet set : sets) text += (text.empty() ? "" : ", ") + std::string(name_of(set));
  return text;
}

}  // namespace

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return "portable";
    case InstructionSet::sse2:
      return "sse2";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  return "";
}

std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  for (const InstructionSet set : all_sets)
    if (name == name_of(set)) return set;
  return std::nullopt;
}

const std::vector<InstructionSet>& supported_instruction_sets() {
  static const std::vector<InstructionSet> sets = [] {
    std::vector<InstructionSet> found;
    for (const InstructionSet set : all_sets)
      if (has(set)) found.push_back(set);
    return found;
  }();
  return sets;
}

std::string instruction_set_problem() {
  if (requested_name().empty()) return "";
  const auto set = instruction_set_named(requested_name());
  if (set && is_supported(*set)) return "";
  return std::string(instruction_set_variable) + "=" + requested_name() + ": " +
         (set ? "this processor does not have it" : "no such instruction set") +
         "; possible here: " + names_of(supported_instruction_sets());
}

InstructionSet active_instruction_set() {
  if (const int value = override_value.load(); value != no_override)
    return static_cast<InstructionSet>(value);
  static const InstructionSet chosen = [] {
    const auto set = instruction_set_named(requested_name());
    return set && is_supported(*set) ? *set : supported_instruction_sets().back();
  }();
  return chosen;
}

void set_instruction_set(std::optional<InstructionSet> set) {
  assert(!set || is_supported(*set));
  override_value = set ? static_cast<int>(*set) : no_override;
}

}  // namespace cloth
