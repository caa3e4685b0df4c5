// What a shape of obstacles is: a class for each (core/scene/shapes/), and the list of them.
//
//     const ObstacleShape& shape = shape_of(obstacle);
//     Eigen::AlignedBox3d bounds = shape.bounds_at(obstacle, pose);
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/rigid_motion.h"
#include "geometry/triangle_intersection.h"
#include "scene/scene.h"

namespace cloth {

/// The kind of body that contact and the view treat an obstacle as. Three have closed forms, by the
/// obstacle's members: a half space by point and normal, a ball by center and radius, a box by center and
/// size. A surface is any other shape: triangles without a thickness of their own, whose vertices, edges and
/// faces continuous contact pairs with those of the cloth.
enum class BodyKind { half_space, ball, box, surface };

struct ShapeFacts {
  const char* name;   ///< in scene files
  const char* title;  ///< for people: "Sphere"
  const char* doc;    ///< in the Add menu
  BodyKind body;
  bool is_from_file = false;  ///< its triangles come from the obstacle's mesh file, which must be given
};

/// Triangles and where they are put: x -> place + rotation (scale x), in m.
struct PlacedSurface {
  std::shared_ptr<const TriangleMesh> mesh;  ///< none: it has not been read
  Vec3 place{0, 0, 0};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 scale{1, 1, 1};
};

/// Where a particle inside an obstacle belongs.
struct SurfacePoint {
  Vec3 point;   ///< m
  Vec3 normal;  ///< outward, of length one
};

/// Of one shape; every obstacle that is given to its functions has it.
class ObstacleShape : public ShapeFacts {
 public:
  virtual ~ObstacleShape() = default;

  /// The parameters that only this shape has.
  virtual Fields<Obstacle> fields() const = 0;

  /// The member that says where it is, m: what it turns about, and what the view's handle moves.
  virtual Vec3& place(Obstacle& obstacle) const = 0;

  /// Fills in a new obstacle for a cloth with this middle and this largest length, in m.
  virtual void start(Obstacle& obstacle, const Vec3& middle, double span) const = 0;

  /// m, where the scene describes it, before any motion; empty: unbounded, or not read.
  virtual Eigen::AlignedBox3d bounds(const Obstacle& obstacle) const = 0;

  /// The same in a pose.
  virtual Eigen::AlignedBox3d bounds_at(const Obstacle& obstacle, const Pose& pose) const;

  /// m, of its thinnest part; infinite where a particle cannot pass to a far side.
  virtual double thickness(const Obstacle&) const { return infinity; }

  /// The stretch and the rotation that lead from one to the other, about their places. Stretches of other
  /// bodies than boxes are the same along all axes.
  virtual Vec3 stretch_between(const Obstacle& from, const Obstacle& to) const = 0;
  virtual Eigen::Matrix3d rotation_between(const Obstacle&, const Obstacle&) const {
    return Eigen::Matrix3d::Identity();
  }

  /// The nearest point of the surface to a point inside; none where it is outside or on the surface, and of
  /// a body that is a surface, which has no inside.
  virtual std::optional<SurfacePoint> penetration(const Obstacle&, const Vec3&) const { return {}; }

  /// The surface point for a particle that moved inside from `from`.
  virtual std::optional<SurfacePoint> entry(const Obstacle& obstacle, const Vec3& from,
                                            const Vec3& point) const;

  /// The point of the surface nearest to one that has moved along it, where it had this normal; none beyond
  /// an edge.
  virtual std::optional<Vec3> along(const Obstacle&, const Vec3& normal, const Vec3& point) const;

  /// Moves the surface outward by `length` in m.
  virtual void grow(Obstacle&, double length) const;

  /// Whether the solid body in a pose touches a triangle; contact asks this of bodies that are no surface.
  virtual bool touches(const Obstacle&, const Pose&, const Corners& triangle) const;

  /// Of a body that is a surface; contact and the view take it from here.
  virtual PlacedSurface surface(const Obstacle&) const { return {}; }

 protected:
  explicit ObstacleShape(const ShapeFacts& facts) : ShapeFacts(facts) {}
};

/// In the order in which menus and pages list them.
const std::vector<const ObstacleShape*>& obstacle_shapes();

inline const ObstacleShape& shape_of(const Obstacle& obstacle) {
  return *obstacle.shape;
}

inline std::optional<SurfacePoint> penetration(const Obstacle& obstacle, const Vec3& point) {
  return shape_of(obstacle).penetration(obstacle, point);
}

/// The triangles in the world, m. Precondition: they have been read.
TriangleMesh placed_mesh(const Obstacle& obstacle);

/// What the declaration of a place shares with those of others.
ParameterInfo place_info(const char* key, const char* label, const char* doc);

// The shapes, a file each; the sphere, with which an obstacle begins, is declared in scene/scene.h.
const ObstacleShape& box_shape();
const ObstacleShape& plane_shape();
const ObstacleShape& mesh_shape();

}  // namespace cloth
