// work_precision_reference.f64: the states of a study's reference while the study is made, so that one that
// goes on need not solve it again. Binary: a table would be three times as long, and no one reads it.
#pragma once

#include <string>
#include <vector>

#include "cloth/cloth_system.h"

namespace cloth {

inline constexpr const char* reference_states_name = "work_precision_reference.f64";

/// One state after the other, of each all positions, then all velocities (m, m/s; x of all particles, then y,
/// then z), as doubles in the machine's order of bytes.
std::string bytes_of(const std::vector<ClothState>& states);

/// The states at horizon * k / samples back, to the bit; none where `bytes` are not exactly these.
std::vector<ClothState> states_from(const std::string& bytes, int particles, int samples, double horizon);

}  // namespace cloth
