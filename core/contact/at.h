// Particles, triangles and edges are counted in int; the standard containers want std::size_t.
#pragma once

#include <cstddef>

namespace cloth {

inline std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

}  // namespace cloth
