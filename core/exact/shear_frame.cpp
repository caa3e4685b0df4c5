#include "exact/shear_frame.h"

#include <cmath>
#include <numbers>

namespace cloth::exact {
namespace {

/// Between a bar and the pull.
double half_angle(double gamma) {
  return std::numbers::pi / 4 - gamma / 2;
}

/// Diagonal of a square of side 1 that shears, less that of the square.
double unit_extension(double gamma) {
  return 2 * std::cos(half_angle(gamma)) - std::numbers::sqrt2;
}

}  // namespace

double shear_energy(ShearLaw law, double c66, double gamma) {
  switch (law) {
    case ShearLaw::angle:
      return c66 * gamma * gamma / 2;
    case ShearLaw::green:
      return c66 * std::sin(gamma) * std::sin(gamma) / 2;
    case ShearLaw::diagonals:
      break;
  }
  return 8 * c66 * std::pow(std::sin(gamma / 4), 2);
}

double shear_moment(ShearLaw law, double c66, double gamma) {
  switch (law) {
    case ShearLaw::angle:
      return c66 * gamma;
    case ShearLaw::green:
      return c66 * std::sin(gamma) * std::cos(gamma);
    case ShearLaw::diagonals:
      break;
  }
  return 2 * c66 * std::sin(gamma / 2);
}

double picture_frame_force(ShearLaw law, double c66, double side, double gamma) {
  return side * shear_moment(law, c66, gamma) / std::sin(half_angle(gamma));
}

double picture_frame_shear_force(ShearLaw law, double c66, double side, double gamma) {
  return picture_frame_force(law, c66, side, gamma) / (2 * std::cos(half_angle(gamma)));
}

double picture_frame_extension(double side, double gamma) {
  return side * unit_extension(gamma);
}

double shear_stiffness_of_frame(ShearLaw law, double force, double side, double gamma) {
  return force / picture_frame_force(law, 1, side, gamma);
}

double bias_extension(double length, double width, double gamma) {
  return (length - width) / std::numbers::sqrt2 * unit_extension(gamma);
}

double bias_shear_angle(double length, double width, double extension) {
  const double distance = length - width;  // between the tips of the triangles that do not shear
  return std::numbers::pi / 2 - 2 * std::acos((distance + extension) / (std::numbers::sqrt2 * distance));
}

double bias_extension_force(ShearLaw law, double c66, double length, double width, double gamma) {
  const double middle = width * (length - 1.5 * width), triangles = width * width;
  const double work =
      middle * shear_moment(law, c66, gamma) + triangles * shear_moment(law, c66, gamma / 2) / 2;
  return work / ((length - width) / std::numbers::sqrt2 * std::sin(half_angle(gamma)));
}

}  // namespace cloth::exact
