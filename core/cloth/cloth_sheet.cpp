#include "cloth/cloth_sheet.h"

#include <algorithm>
#include <array>

namespace cloth {
namespace {

constexpr std::array<const char*, named_pin_count> pin_names{"top-left",     "top-right", "bottom-left",
                                                             "bottom-right", "top-edge",  "bottom-edge",
                                                             "left-edge",    "right-edge"};

struct ParticleRange {
  int row_begin, row_end, column_begin, column_end;
};

ParticleRange range_of(NamedPin pin, int rows, int columns) {
  switch (pin) {
    case NamedPin::top_left:
      return {0, 1, 0, 1};
    case NamedPin::top_right:
      return {0, 1, columns - 1, columns};
    case NamedPin::bottom_left:
      return {rows - 1, rows, 0, 1};
    case NamedPin::bottom_right:
      return {rows - 1, rows, columns - 1, columns};
    case NamedPin::top_edge:
      return {0, 1, 0, columns};
    case NamedPin::bottom_edge:
      return {rows - 1, rows, 0, columns};
    case NamedPin::left_edge:
      return {0, rows, 0, 1};
    case NamedPin::right_edge:
      return {0, rows, columns - 1, columns};
  }
  return {0, 0, 0, 0};
}

ParticleRange range_of(const PinnedParticle& pin, int rows, int columns) {
  if (pin.row < 0 || pin.row >= rows || pin.column < 0 || pin.column >= columns) return {0, 0, 0, 0};
  return {pin.row, pin.row + 1, pin.column, pin.column + 1};
}

}  // namespace

const char* name_of(NamedPin pin) {
  return pin_names[static_cast<std::size_t>(pin)];
}

std::optional<NamedPin> pin_named(const std::string& name) {
  const auto found = std::find(pin_names.begin(), pin_names.end(), name);
  if (found == pin_names.end()) return std::nullopt;
  return static_cast<NamedPin>(found - pin_names.begin());
}

std::vector<int> pinned_particles(const ClothSheet& cloth) {
  std::vector<int> particles;
  for (const Pin& pin : cloth.pins) {
    const ParticleRange range =
        std::visit([&](const auto& which) { return range_of(which, cloth.rows, cloth.columns); }, pin);
    for (int row = range.row_begin; row < range.row_end; ++row)
      for (int column = range.column_begin; column < range.column_end; ++column)
        particles.push_back(row * cloth.columns + column);
  }
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

}  // namespace cloth
