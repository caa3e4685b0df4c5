#include "cloth/cloth_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/cut_grid.h"

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

template <class OneRange>  // a named pin or one particle
void add_places(const OneRange& pin, const ClothSheet& cloth, std::vector<int>& places) {
  const ParticleRange range = range_of(pin, cloth.rows, cloth.columns);
  for (int row = range.row_begin; row < range.row_end; ++row)
    for (int column = range.column_begin; column < range.column_end; ++column)
      places.push_back(row * cloth.columns + column);
}

void add_places(const PinnedDisc& pin, const ClothSheet& cloth, std::vector<int>& places) {
  if (cloth.is_mesh()) return;
  const Vec3 across = cloth.across.normalized() * (cloth.width / (cloth.columns - 1)),
             down = cloth.down.normalized() * (cloth.height / (cloth.rows - 1));
  const double cell = std::sqrt(across.cross(down).norm());
  constexpr double rounding = 1 + 1e-12;  // what lies on the rim is held on every grid
  const double reach = (pin.radius + cells_beyond_disc * cell) * rounding;
  for (int row = 0; row < cloth.rows; ++row)
    for (int column = 0; column < cloth.columns; ++column) {
      const Vec3 from_middle =
          across * (column - 0.5 * (cloth.columns - 1)) + down * (row - 0.5 * (cloth.rows - 1));
      if (from_middle.norm() <= reach) places.push_back(row * cloth.columns + column);
    }
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
  for (const Pin& pin : cloth.pins)
    std::visit([&](const auto& which) { add_places(which, cloth, particles); }, pin);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  if (!cloth.is_cut()) return particles;
  const CutGrid grid = cut_grid(cloth);
  for (int& particle : particles) particle = grid.particle[static_cast<std::size_t>(particle)];
  std::erase(particles, -1);
  return particles;
}

}  // namespace cloth
