// What a cloth is made of, in units that do not depend on its grid: stiffness for each metre of width, mass,
// bending, damping and drag for each square metre. On a grid it becomes springs, masses and bending elements
// cell by cell (cloth/material_grid.cpp), so that half of a cell's share is at its edges and a quarter at its
// corners; on a mesh triangles of constant strain (cloth/material_mesh.h). The warp runs along the sheet's
// `down`, the weft along its `across`.
#pragma once

#include <optional>

namespace cloth {

struct Material {
  double areal_density = 0;                   ///< kg/m^2
  double stretch_warp = 0, stretch_weft = 0;  ///< N/m: C11 and C22
  double shear = 0;                           ///< N/m: C66, force over the shear angle 2 e_xy
  double bending_warp = 0, bending_weft = 0;  ///< N m: moment for each metre of width over curvature
  double twist = 0;  ///< N m: energy of a twisted square metre over the twist's square
  double hysteresis_warp = 0,
         hysteresis_weft = 0;                   ///< N: 2HB, the width of the loop of moment over curvature
  double stretch_damping = 0;                   ///< s: of a spring's damper over its stiffness
  double bending_damping = 0;                   ///< s
  double mass_damping = 0;                      ///< 1/s
  double drag_normal = 0, drag_tangential = 0;  ///< N s/m^3: force of the air for each area and speed
  /// N/m: C12, pull across over strain along. A grid's springs have as much as they resist shear; "auto" is
  /// that.
  std::optional<double> coupling{};
  bool operator==(const Material&) const = default;
};

/// C12 in N/m.
double coupling_of(const Material& material);

/// Springs of a grid of cells `across` by `down` metres that stretch and shear as the material does, exactly
/// where the strain is the same everywhere: the stiffness in N/m of those along a row, along a column and of
/// both diagonals. From the energy of a cell, d^2 = across^2 + down^2: the diagonals of stiffness k give
/// 2 k across down/d^2 to C66, 2 k across^3/(down d^2) to the stiffness along `across` and
/// 2 k down^3/(across d^2) to that along `down`. A negative one: the material does not fit springs on such
/// cells.
struct CellSprings {
  double across = 0, down = 0, diagonal = 0;
};
CellSprings cell_springs(const Material& material, double across, double down);

/// The largest C66 in N/m that springs on such cells can have.
double largest_shear(const Material& material, double across, double down);

/// The stiffness in N/m of the bending elements (cloth/bending.h) inside a grid: B area/spacing^4 of those
/// along rows and columns, 2 B_t/area of the twist of a cell.
struct CellBending {
  double across = 0, down = 0, twist = 0;
};
CellBending cell_bending(const Material& material, double across, double down);

/// The twist in N m of a material that was bent along the warp, the weft and at 45 degrees between: without
/// Poisson's effect B(theta) = B_warp c^4 + B_weft s^4 + 2 twist c^2 s^2 (orthotropic plate, Timoshenko and
/// Woinowsky-Krieger 1959, section 85). Negative where B_45 is less than a quarter of the others' sum.
double twist_from(double bending_warp, double bending_weft, double bending_45);

/// The bending stiffness in N m at an angle from the warp, in rad.
double bending_at(const Material& material, double angle);

}  // namespace cloth
