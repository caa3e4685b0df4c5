// The two tests of a cloth's shear stiffness C66 (N/m), for threads that do not stretch and turn without
// bending. The shear angle gamma (rad) is what the right angle between warp and weft has lost.
//
// Picture frame: four hinged bars of length L, pulled apart at two opposite corners, 2 L cos(pi/4 - gamma/2)
// from each other. Bias extension: a strip cut at 45 degrees, length at least twice the width W, pulled along
// its length: the middle shears by gamma, four triangles by gamma/2, the ends not at all. Forces follow from
// the work done, F d = the energy stored (Cao et al. 2008).
#pragma once

namespace cloth::exact {

/// What "linear" means beyond small angles. U(gamma): energy per area, C66 gamma^2/2 to second order.
enum class ShearLaw {
  angle,     ///< C66 gamma^2/2
  green,     ///< C66 sin(gamma)^2/2: Green's strain (St. Venant-Kirchhoff), triangles of constant strain
  diagonals  ///< 4 C66 (1 - cos(gamma/2)): two linear springs of stiffness C66 along the diagonals of square
             ///< cells
};

double shear_energy(ShearLaw law, double c66, double gamma);  ///< U, J/m2
double shear_moment(ShearLaw law, double c66, double gamma);  ///< dU/d gamma, N/m

/// Pull at the corners, N: L U'/sin(pi/4 - gamma/2). `side` in m, gamma < pi/2.
double picture_frame_force(ShearLaw law, double c66, double side, double gamma);
/// Along each bar, N: L U'/cos(gamma) = F/(2 cos(pi/4 - gamma/2)); C66 L sin(gamma) for Green's strain.
double picture_frame_shear_force(ShearLaw law, double c66, double side, double gamma);
/// By how much the corners have moved apart, m.
double picture_frame_extension(double side, double gamma);
/// C66 (N/m) of a cloth that pulls at the corners with `force` (N) at this angle.
double shear_stiffness_of_frame(ShearLaw law, double force, double side, double gamma);

/// Extension of the strip (m) <-> shear angle of its middle.
double bias_extension(double length, double width, double gamma);
double bias_shear_angle(double length, double width, double extension);
/// Pull at the ends of the strip, N.
double bias_extension_force(ShearLaw law, double c66, double length, double width, double gamma);

}  // namespace cloth::exact
