// What the key light does not reach because something else is in its way: a map of depths seen from the
// light.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

class KeyShadow {
 public:
  KeyShadow() = default;
  /// For what lies within `bounds` (m), in light from far away along -`towards_light` (unit vector).
  KeyShadow(const Vec3& towards_light, const Eigen::AlignedBox3d& bounds);

  void add_triangle(const std::array<Vec3, 3>& corners);
  /// The share of the key light that is kept off `point`, with soft edges: 0 to 1.
  float at(const Eigen::Vector3f& point) const;

 private:
  Vec3 in_light(const Vec3& point) const;  ///< texels, texels, metres towards the light

  static constexpr int size_ = 512, soft_ = 3;
  Vec3 right_{1, 0, 0}, up_{0, 1, 0}, towards_{0, 0, 1}, middle_{0, 0, 0};
  double texel_ = 1, slack_ = 0;  ///< m
  std::vector<float> nearest_;    ///< the greatest height towards the light, by texel
};

}  // namespace cloth
