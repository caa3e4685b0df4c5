#include "document/cloth_edits.h"

#include <algorithm>
#include <set>

namespace clothlab {
namespace {

using cloth::ClothSheet;
using cloth::NamedPin;
using cloth::Pin;
using cloth::PinnedParticle;
using cloth::Vec3;

/// The same grid with nothing cut away, where a particle's number is row * columns + column.
ClothSheet whole(ClothSheet sheet) {
  sheet.cut = "none";
  return sheet;
}

/// The particles of one pin, by the core's own rule.
std::vector<int> particles_of(ClothSheet sheet, const Pin& pin) {
  sheet.pins = {pin};
  return pinned_particles(sheet);
}

bool holds(const std::vector<int>& ascending, int particle) {
  return std::binary_search(ascending.begin(), ascending.end(), particle);
}

Pin pin_at(const ClothSheet& sheet, int row, int column) {
  const int particle = row * sheet.columns + column;
  if (sheet.is_mesh() || sheet.is_cut()) return PinnedParticle{row, column};
  for (const NamedPin corner :
       {NamedPin::top_left, NamedPin::top_right, NamedPin::bottom_left, NamedPin::bottom_right})
    if (particles_of(sheet, corner) == std::vector<int>{particle}) return corner;
  return PinnedParticle{row, column};
}

std::vector<Pin> without(const ClothSheet& sheet, int particle) {
  ClothSheet rest = whole(sheet);
  rest.pins.clear();
  std::set<int> freed;  // with their pin, unless another pin holds them too
  for (const Pin& pin : sheet.pins) {
    const std::vector<int> particles = particles_of(whole(sheet), pin);
    if (holds(particles, particle))
      freed.insert(particles.begin(), particles.end());
    else
      rest.pins.push_back(pin);
  }
  freed.erase(particle);
  for (const int held : pinned_particles(rest)) freed.erase(held);
  for (const int other : freed) {
    const Pin pin = PinnedParticle{other / sheet.columns, other % sheet.columns};
    if (!particles_of(sheet, pin).empty()) rest.pins.push_back(pin);
  }
  return rest.pins;
}

}  // namespace

Vec3 middle_of(const ClothSheet& sheet) {
  if (sheet.is_mesh())
    return sheet.mesh.is_loaded() ? Vec3(sheet.origin + sheet.mesh.loaded->bounds.center()) : sheet.origin;
  return sheet.origin + 0.5 * sheet.width * sheet.across.normalized() +
         0.5 * sheet.height * sheet.down.normalized();
}

ClothSheet grid_in_place_of(const ClothSheet& mesh) {
  ClothSheet grid;
  grid.mass = mesh.mass;
  const Vec3 size = mesh.mesh.is_loaded() ? Vec3(mesh.mesh.loaded->bounds.sizes()) : Vec3(Vec3::Ones());
  const bool upright = size.y() >= size.z();
  const double least = 0.1 * size.maxCoeff();  // of a mesh that is a line, or nearly
  if (size.maxCoeff() > 0) {
    grid.width = std::max(size.x(), least);
    grid.height = std::max(upright ? size.y() : size.z(), least);
  }
  grid.down = upright ? Vec3(0, -1, 0) : Vec3(0, 0, 1);
  grid.origin = middle_of(mesh) - 0.5 * grid.width * grid.across - 0.5 * grid.height * grid.down;
  return grid;
}

bool is_pinned(const ClothSheet& sheet, int row, int column) {
  const bool inside = row >= 0 && row < sheet.rows && column >= 0 && column < sheet.columns;
  return inside && holds(pinned_particles(whole(sheet)), row * sheet.columns + column);
}

std::vector<Pin> toggled_pins(const ClothSheet& sheet, int row, int column) {
  if (row < 0 || row >= sheet.rows || column < 0 || column >= sheet.columns) return sheet.pins;
  if (is_pinned(sheet, row, column)) return without(sheet, row * sheet.columns + column);
  std::vector<Pin> pins = sheet.pins;
  pins.push_back(pin_at(sheet, row, column));
  return pins;
}

std::vector<Pin> pins_inside(const ClothSheet& sheet) {
  std::vector<Pin> pins;
  for (const Pin& pin : sheet.pins)
    if (!particles_of(sheet, pin).empty()) pins.push_back(pin);
  return pins;
}

}  // namespace clothlab
