#include "cloth/material.h"

#include <algorithm>
#include <cmath>

namespace cloth {

double coupling_of(const Material& material) {
  return material.coupling.value_or(material.shear);
}

CellSprings cell_springs(const Material& material, double across, double down) {
  const double ratio = across / down, square = ratio * ratio;
  return {.across = (material.stretch_weft - material.shear * square) / ratio,
          .down = (material.stretch_warp - material.shear / square) * ratio,
          .diagonal = material.shear * (across * across + down * down) / (2 * across * down)};
}

double largest_shear(const Material& material, double across, double down) {
  const double square = (across / down) * (across / down);
  return std::min(material.stretch_weft / square, material.stretch_warp * square);
}

CellBending cell_bending(const Material& material, double across, double down) {
  const double area = across * down;
  return {.across = material.bending_weft * area / std::pow(across, 4),
          .down = material.bending_warp * area / std::pow(down, 4),
          .twist = 2 * material.twist / area};
}

double twist_from(double bending_warp, double bending_weft, double bending_45) {
  return 2 * bending_45 - 0.5 * (bending_warp + bending_weft);
}

double bending_at(const Material& material, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), both = c * s;
  return material.bending_warp * std::pow(c, 4) + material.bending_weft * std::pow(s, 4) +
         2 * material.twist * both * both;
}

}  // namespace cloth
