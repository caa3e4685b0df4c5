// Converts the int indices of particles, triangles and edges to the std::size_t of the standard containers.
#pragma once

#include <cstddef>

namespace cloth {

inline std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

}  // namespace cloth
