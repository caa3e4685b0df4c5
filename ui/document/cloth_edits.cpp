#include "document/cloth_edits.h"

#include <algorithm>

namespace clothlab {

using cloth::ClothSheet;
using cloth::Vec3;

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

}  // namespace clothlab
