// The description of a cloth in a scene: a sheet, its pins and the stiffness of its springs. SI units
// throughout.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/loaded_mesh.h"
#include "params/parameter.h"

namespace cloth {

enum class NamedPin {
  top_left,
  top_right,
  bottom_left,
  bottom_right,
  top_edge,
  bottom_edge,
  left_edge,
  right_edge
};

struct PinnedParticle {
  int row = 0, column = 0;
  bool operator==(const PinnedParticle&) const = default;
};

/// Every particle of a grid that starts within `radius` of the sheet's middle and 0.4 cells more. The
/// outermost of these particles, where the cloth begins to bend, lie between that and nearly one cell further
/// in: with 0.4 they are on the rim of the disc in the mean, with 0 the disc would be too small by 0.4 cells.
struct PinnedDisc {
  double radius = 0;  ///< m
  bool operator==(const PinnedDisc&) const = default;
};
inline constexpr double cells_beyond_disc = 0.4;

using Pin = std::variant<NamedPin, PinnedParticle, PinnedDisc>;

/// A grid of rows x columns particles, row-major from `origin`; top is row 0, left is column 0. Of a round
/// one (cloth/cut_grid.h) only a part is there, and its particles are numbered without the others. With a
/// mesh its vertices instead, shifted by `origin`: they count as one row, and width, height, across, down and
/// cut say nothing.
struct ClothSheet {
  MeshChoice mesh = {};  ///< no file: a grid
  int columns = 33, rows = 33;
  double width = 1.0, height = 1.0;  ///< m
  double mass = 0.25;                ///< kg, of the whole cloth
  Vec3 origin{-0.5, 1.0, 0.0};       ///< m, where particle (0, 0) starts
  Vec3 across{1, 0, 0}, down{0, -1, 0};
  std::string cut = "none";  ///< or "round"
  std::vector<Pin> pins;
  bool is_cut() const { return !is_mesh() && cut == "round"; }
  bool is_mesh() const { return !mesh.file.empty(); }
  bool operator==(const ClothSheet&) const = default;
};

/// Stiffnesses in N/m; a family of stiffness 0 does not exist.
struct SpringMaterial {
  double structural = 0, shear = 0, flexion = 0;
  double damping = 0;  ///< N s/m, along every spring
  bool operator==(const SpringMaterial&) const = default;
};

const char* name_of(NamedPin pin);
std::optional<NamedPin> pin_named(const std::string& name);
inline constexpr int named_pin_count = 8;

/// The particles that `pins` hold, by their numbers in the cloth (row * columns + column where nothing is cut
/// away), ascending, each once. Pins outside the grid or what is left of it are ignored.
std::vector<int> pinned_particles(const ClothSheet& cloth);

}  // namespace cloth
