// Planes: a barely tinted floor with a faint grid that fades with distance, and the soft shadow on it. One
// that is not level is a sheet, or its slope would look like ground seen askew.
#pragma once

#include <span>

#include "picture/picture_theme.h"
#include "picture/rasteriser.h"

namespace cloth {

/// How much of the light from straight above or nearly so is kept off the level plane at `height`.
class FloorShadow {
 public:
  FloorShadow() = default;
  /// `bounds` (m) of all that will be added.
  FloorShadow(double height, const Vec3& towards_light, const Eigen::AlignedBox3d& bounds);
  /// Triangles as in Rasteriser::add_mesh.
  void add(std::span<const PictureVertex> vertices, std::span<const int> triangles);
  void blur();
  /// 0: none, to 1. x and z in metres.
  float at(double x, double z) const;

 private:
  void add_triangle(const std::array<Vec3, 3>& corners);

  static constexpr int size_ = 256;
  double height_ = 0, left_ = 0, back_ = 0, texel_ = 0, fade_height_ = 1;
  Vec3 light_{0, 1, 0};
  std::vector<float> cover_;
};

struct Floor {
  Vec3 point, normal;   ///< normal: unit vector
  Vec3 axis_u, axis_v;  ///< within the plane, along which the grid's lines run
  Vec3 middle;          ///< where it is least faded
  double reach = 1;     ///< m
  double grid_step = 0.1;
  const FloorShadow* shadow = nullptr;
  Colour ground, line, shade;  ///< of the plane, its grid and what lies in the shadow
  float ground_opacity, line_opacity, shade_opacity;

  Floor(const Vec3& point, const Vec3& normal, const Eigen::AlignedBox3d& extent, const PictureTheme& theme);

  bool is_level() const { return std::abs(normal.y()) > 0.999; }
};

/// Lays the floor over the samples of a band that lie behind it.
void lay_floor(const Floor& floor, const EyeFrame& frame, SampleBand& band);

}  // namespace cloth
