// Where a picture is taken from. Pixels are counted from the top left corner: x to the right, y down; the
// middle of the first pixel is (0.5, 0.5).
#pragma once

#include <span>

#include "cloth/cloth_system.h"
#include "picture/image.h"
#include "scene/scene.h"

namespace cloth {

struct PictureCamera {
  Vec3 eye{1.5, 1.2, 2.4}, target{0, 0.5, 0};  ///< m
  Vec3 up{0, 1, 0};                            ///< any length; seen upright
  double field_of_view = 34.4;                 ///< degrees, over the height of the picture
  bool operator==(const PictureCamera&) const = default;
};

struct PictureArrow {
  Vec3 from, to;  ///< m
  Rgb colour{0x34, 0x57, 0xd5};
};

/// From the right and somewhat above: a hanging cloth shows its folds, and a body its top.
inline const Vec3 usual_direction{0.46, 0.40, 0.80};

/// A camera that looks along -`direction` (from what is seen towards the eye; any length) at the cloth and
/// the obstacles (planes apart), near enough to fill a picture of `aspect` (width / height) with a little air
/// around. Obstacles that move are where they are at `time` (s). Particles that are not finite are left out;
/// the usual camera where nothing is left.
PictureCamera camera_showing(const Scene& scene, const Vec3Field& position,
                             const Vec3& direction = usual_direction, double aspect = 4.0 / 3.0,
                             std::span<const PictureArrow> arrows = {}, double time = 0);

/// What moves the eye to the origin: x right, y up, z into the picture. Finite whatever the camera is.
struct EyeFrame {
  Vec3 eye, right, up, forward;       ///< m; unit vectors
  double focal_length = 1;            ///< px: at depth z, a metre is focal_length / z pixels
  double middle_x = 0, middle_y = 0;  ///< px
  double near = 1e-3;                 ///< m, the least depth that is drawn

  EyeFrame(const PictureCamera& camera, int width, int height);
  Vec3 to_eye(const Vec3& point) const;                ///< m: right, up, depth
  Eigen::Vector2d to_pixel(const Vec3& in_eye) const;  ///< needs depth > 0
  Vec3 ray(double x, double y) const;                  ///< through a pixel, with a depth of 1
};

}  // namespace cloth
