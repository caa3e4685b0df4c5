#include "cloth/cloth_sheet.h"

#include <algorithm>
#include <array>

namespace cloth {
namespace {

struct ParticleRange {
  int row_begin, row_end, column_begin, column_end;
};

/// What a named pin holds of the rows, and of the columns.
enum class Part { first, last, all };
struct PinPlace {
  const char* name;
  Part rows, columns;
};
constexpr std::array<PinPlace, named_pin_count> pin_places{{
    {"top-left", Part::first, Part::first},
    {"top-right", Part::first, Part::last},
    {"bottom-left", Part::last, Part::first},
    {"bottom-right", Part::last, Part::last},
    {"top-edge", Part::first, Part::all},
    {"bottom-edge", Part::last, Part::all},
    {"left-edge", Part::all, Part::first},
    {"right-edge", Part::all, Part::last},
}};

ParticleRange range_of(NamedPin pin, int rows, int columns) {
  const PinPlace& place = pin_places[static_cast<std::size_t>(pin)];
  const auto begin = [](Part part, int count) { return part == Part::last ? count - 1 : 0; };
  const auto end = [](Part part, int count) { return part == Part::first ? 1 : count; };
  return {begin(place.rows, rows), end(place.rows, rows), begin(place.columns, columns),
          end(place.columns, columns)};
}

ParticleRange range_of(const PinnedParticle& pin, int rows, int columns) {
  if (pin.row < 0 || pin.row >= rows || pin.column < 0 || pin.column >= columns) return {0, 0, 0, 0};
  return {pin.row, pin.row + 1, pin.column, pin.column + 1};
}

}  // namespace

const char* name_of(NamedPin pin) {
  return pin_places[static_cast<std::size_t>(pin)].name;
}

std::optional<NamedPin> pin_named(const std::string& name) {
  const auto found =
      std::find_if(pin_places.begin(), pin_places.end(), [&](const PinPlace& p) { return p.name == name; });
  if (found == pin_places.end()) return std::nullopt;
  return static_cast<NamedPin>(found - pin_places.begin());
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
