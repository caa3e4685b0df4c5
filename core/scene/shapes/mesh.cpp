#include <numbers>

#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

/// R_z R_y R_x.
Eigen::Matrix3d rotation_of(const Obstacle& mesh) {
  const Vec3 angle = mesh.rotate * (std::numbers::pi / 180);
  using Turn = Eigen::AngleAxisd;
  return (Turn(angle.z(), Vec3::UnitZ()) * Turn(angle.y(), Vec3::UnitY()) * Turn(angle.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

class MeshShape final : public ObstacleShape {
 public:
  MeshShape()
      : ObstacleShape({"mesh", "Mesh", "A body of any shape under the cloth, from an OBJ file.",
                       BodyKind::surface, true}) {}

  Fields<Obstacle> fields() const override {
    return {field(&Obstacle::mesh, {.key = "file",
                                    .label = "Mesh",
                                    .doc = "OBJ file, as seen from the scene's folder, or built-in mesh."}),
            field(&Obstacle::scale, positive({.key = "scale",
                                              .label = "Scale",
                                              .doc = "Factor on the file's lengths.",
                                              .scale = Scale::logarithmic,
                                              .smallest = 1e-9,
                                              .slider_minimum = 0.01,
                                              .slider_maximum = 100})),
            field(&Obstacle::rotate, {.key = "rotate",
                                      .label = "Rotation",
                                      .unit = "deg",
                                      .doc = "Turns about the x, then the y, then the z axis.",
                                      .slider_minimum = -180,
                                      .slider_maximum = 180}),
            field(&Obstacle::translate, {.key = "translate",
                                         .label = "Position",
                                         .unit = "m",
                                         .doc = "Where the file's origin is put.",
                                         .formula = "x = translate + R_z R_y R_x scale x_file",
                                         .slider_minimum = -2,
                                         .slider_maximum = 2})};
  }
  Vec3& place(Obstacle& mesh) const override { return mesh.translate; }
  void start(Obstacle& mesh, const Vec3& middle, double span) const override {
    mesh.mesh.file = "bunny.obj";
    mesh.scale = 0.5 * span;
    mesh.translate = middle - Vec3(0, span, 0);
  }
  /// That of the turned box around the file's mesh.
  Eigen::AlignedBox3d bounds(const Obstacle& mesh) const override {
    Eigen::AlignedBox3d bounds;
    if (!mesh.mesh.is_loaded()) return bounds;
    const Eigen::Matrix3d turn = mesh.scale * rotation_of(mesh);
    for (int k = 0; k < 8; ++k) {
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(k);
      bounds.extend(Vec3(mesh.translate + turn * mesh.mesh.loaded->bounds.corner(corner)));
    }
    return bounds;
  }
  Vec3 stretch_between(const Obstacle& from, const Obstacle& to) const override {
    return Vec3::Constant(to.scale / from.scale);
  }
  Eigen::Matrix3d rotation_between(const Obstacle& from, const Obstacle& to) const override {
    if (from.rotate == to.rotate) return Eigen::Matrix3d::Identity();
    return rotation_of(to) * rotation_of(from).transpose();
  }
  PlacedSurface surface(const Obstacle& mesh) const override {
    PlacedSurface surface;
    surface.place = mesh.translate;
    surface.rotation = rotation_of(mesh);
    surface.scale = Vec3::Constant(mesh.scale);
    if (mesh.mesh.loaded) surface.mesh = {mesh.mesh.loaded, &mesh.mesh.loaded->surface};
    return surface;
  }
};

}  // namespace

const ObstacleShape& mesh_shape() {
  static const MeshShape shape;
  return shape;
}

}  // namespace cloth
