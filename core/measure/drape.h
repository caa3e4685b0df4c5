// The drape of a cloth over a disc as Cusick's test has it (Cusick 1968; ISO 9073-9): a round specimen lies
// on a smaller disc, and light from above casts its shadow.
//
//     const Drape drape = measure_drape(triangles_of(system), system.start, position, {.radius = 0.09});
//     // drape.coefficient, drape.folds
#pragma once

#include "geometry/triangle_mesh.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// The disc that the specimen lies on, and where up is.
struct DrapeDisc {
  Vec3 middle{0, 0, 0};  ///< m
  double radius = 0.09;  ///< m
  Vec3 up{0, 1, 0};      ///< a unit vector
};

struct Drape {
  double shadow = 0;    ///< m^2, of cloth and disc together
  double specimen = 0;  ///< m^2, of the flat cloth
  /// (shadow - disc)/(specimen - disc): 1 where the cloth stays flat, 0 where it hangs straight down.
  double coefficient = 0;
  /// Peaks of the shadow's outline, as seen beside that of the flat cloth, which may have steps of its own;
  /// they stand out by two hundredths of the specimen's radius on both sides.
  int folds = 0;
  double amplitude = 0;  ///< m, half of what peaks are beyond valleys in the mean; 0: less than two folds
};

/// The area in m^2 of all that lies below or above the horizontal plane through the disc's middle, with the
/// disc: exact along each of `lines` parallel lines and by the midpoint rule across them. Where the shadow's
/// width along the lines changes by V in all, the error is at most V times half of their spacing; for a disc
/// it falls with the power 3/2 of the spacing. Not a number where a position is not finite, as the outline.
double shadow_area(const std::vector<Triangle>& triangles, const Vec3Field& position, const DrapeDisc& disc,
                   int lines = 2000);

/// How far the shadow's outline is from the disc's middle, m, in `directions` even steps around it; at least
/// the disc's radius.
std::vector<double> shadow_outline(const std::vector<Triangle>& triangles, const Vec3Field& position,
                                   const DrapeDisc& disc, int directions = 720);

/// `flat`: the positions of the flat specimen on the disc.
Drape measure_drape(const std::vector<Triangle>& triangles, const Vec3Field& flat, const Vec3Field& position,
                    const DrapeDisc& disc);

/// Folds of an outline: radii in m in even steps around. Harmonics up to the 24th alone are looked at.
struct FoldCount {
  int folds = 0;
  double amplitude = 0;  ///< m
};
FoldCount count_folds(const std::vector<double>& outline, double prominence);

}  // namespace cloth
