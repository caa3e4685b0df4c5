// The shape in which a cloth stays: where springs or material and gravity balance, with nothing that moves
// it.
#pragma once

#include <functional>
#include <string>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

struct RestOptions {
  /// Net force, as the norm over all free particles, over their weight; where rounding alone leaves more than
  /// that is enough.
  double tolerance = 1e-10;
  int iterations = 600;
  /// Of a cloth with hysteresis: its weight comes in so many equal parts, and its threads slip after each.
  int load_steps = 1;
  double longest_move = 0.02;  ///< of a particle in one iteration, over the sheet's diagonal
  /// Asked before each iteration; true ends the search, which then has found nothing. Empty: nothing does.
  std::function<bool()> stop{};
};

struct RestShape {
  Vec3Field position;   ///< m, the best that was found
  double residual = 0;  ///< net force over weight
  int iterations = 0;
  bool found = false;
  std::string failure;  ///< in words, where nothing was found
};

/// A minimum of the elastic, bending and gravity energy near `from`, by Newton's method with the masses as
/// Levenberg's shift (Levenberg 1944; More 1978) and Armijo's rule on the energy: the shift falls as long as
/// whole steps are taken, and rises where the energy does not fall. Where the exact second derivative is not
/// positive definite, compressed springs lose their part across. Air, damping, contact and the deformation
/// rate are left out. With hysteresis it is the rest of a cloth that was flat and without weight before.
/// `system` is make_cloth(scene), possibly with other masses or rest lengths.
RestShape find_rest(const Scene& scene, const ClothSystem& system, const Vec3Field& from,
                    const RestOptions& options = {});

/// From the starting shape of the scene's cloth.
RestShape find_rest(const Scene& scene, const RestOptions& options = {});

/// Whether the energy rises in every direction from this shape: with no pin it never does.
bool is_minimum(const Scene& scene, const ClothSystem& system, const Vec3Field& position);

/// What springs or material and gravity exert on every particle, pinned ones too; N.
Vec3Field conservative_forces(const Scene& scene, const ClothSystem& system, const Vec3Field& position);

}  // namespace cloth
