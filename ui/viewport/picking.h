// Finds the particle under the cursor and the part of the cloth inside the picture.
#pragma once

#include <optional>

#include "bridge/frame.h"
#include "viewport/camera.h"

namespace clothlab {

inline constexpr double picking_tolerance = 12;  ///< px, around particles the ray passes by

/// The particle nearest to where the ray through `cursor` (px) first meets the cloth; if it meets none, the
/// particle that is drawn nearest to the cursor within the tolerance.
std::optional<int> pick_particle(const ClothFrame& frame, const Camera& camera,
                                 const Eigen::Vector2d& cursor);

/// The share of the cloth's particles that lies in a picture of this size (px); of a large cloth only every
/// n-th particle is tested.
double share_in_picture(const ClothFrame& frame, const Camera& camera, const Eigen::Vector2d& size);

/// m along the ray to the triangle p q r, from either side; negative if it passes by (Moeller and Trumbore
/// 1997).
double distance_to_triangle(const Ray& ray, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                            const Eigen::Vector3d& r);

Eigen::Vector3d particle_position(const ClothFrame& frame, int particle);  ///< m

}  // namespace clothlab
