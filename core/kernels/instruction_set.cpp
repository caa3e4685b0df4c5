#include "kernels/instruction_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstdlib>

namespace cloth {
namespace {

constexpr std::array set_names{"portable", "avx2", "avx512"};  // in the order of InstructionSet
constexpr int no_override = -1;
std::atomic<int> override_value = no_override;

bool has(InstructionSet set) {
#ifdef CLOTHLAB_X86_KERNELS
  if (set == InstructionSet::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
  return set == InstructionSet::portable;
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

}  // namespace

const char* name_of(InstructionSet set) {
  return set_names.at(static_cast<std::size_t>(set));
}

std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  for (std::size_t k = 0; k < set_names.size(); ++k)
    if (name == set_names[k]) return static_cast<InstructionSet>(k);
  return std::nullopt;
}

const std::vector<InstructionSet>& supported_instruction_sets() {
  static const std::vector<InstructionSet> sets = [] {
    std::vector<InstructionSet> found;
    for (std::size_t k = 0; k < set_names.size(); ++k)
      if (const auto set = static_cast<InstructionSet>(k); has(set)) found.push_back(set);
    return found;
  }();
  return sets;
}

std::string instruction_set_problem() {
  if (requested_name().empty()) return "";
  const auto set = instruction_set_named(requested_name());
  if (set && is_supported(*set)) return "";
  std::vector<std::string> possible;
  for (const InstructionSet each : supported_instruction_sets()) possible.push_back(name_of(each));
  return fmt::format("{}={}: {}; possible here: {}", instruction_set_variable, requested_name(),
                     set ? "this processor does not have it" : "no such instruction set",
                     fmt::join(possible, ", "));
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
