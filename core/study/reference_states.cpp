#include "study/reference_states.h"

#include <cstring>

namespace cloth {

std::string bytes_of(const std::vector<ClothState>& states) {
  std::string bytes;
  for (const ClothState& state : states)
    for (const Vec3Field* field : {&state.position, &state.velocity}) {
      const std::span<const double> numbers = field->flat();
      bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    }
  return bytes;
}

std::vector<ClothState> states_from(const std::string& bytes, int particles, int samples, double horizon) {
  if (particles < 1 || samples < 1) return {};
  const auto count = static_cast<std::size_t>(particles);
  if (bytes.size() != static_cast<std::size_t>(samples) * 6 * count * sizeof(double)) return {};
  std::vector<ClothState> states;
  const char* from = bytes.data();
  for (int k = 1; k <= samples; ++k) {
    ClothState state{.position = Vec3Field(count), .velocity = Vec3Field(count)};
    for (Vec3Field* field : {&state.position, &state.velocity}) {
      std::memcpy(field->flat().data(), from, field->flat().size_bytes());
      from += field->flat().size_bytes();
    }
    state.time = horizon * k / samples;
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace cloth
