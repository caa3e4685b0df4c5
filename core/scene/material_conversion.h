// Springs as the material that they are on their grid, and a material as springs on its grid, each with what
// cannot be said.
//
//     const SceneConversion to = with_material(scene);
//     if (to.scene) for (const std::string& loss : to.losses) ...
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

/// A scene, or why there is none. Exactly one of the two is there.
struct SceneConversion {
  std::optional<Scene> scene;
  std::string refusal{};              ///< a sentence
  std::vector<std::string> losses{};  ///< a sentence for everything in which it is another cloth
};

/// Springs, damping for each particle, mass and drag as a material that is the same cloth inside the grid. Of
/// cells `a` across by `b` down, d^2 = a^2 + b^2, springs of stiffness k_s, k_sh and k_f have, from the
/// energy of a cell, C22 = (k_s + 4 k_f) a/b + 2 k_sh a^3/(b d^2), C11 likewise with a and b exchanged, and
/// C66 = C12 = 2 k_sh a b/d^2.
SceneConversion with_material(const Scene& scene);

/// The way back.
SceneConversion with_springs(const Scene& scene);

}  // namespace cloth
