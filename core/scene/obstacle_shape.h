// The interface of obstacle shapes, implemented by one class for each shape (core/scene/shapes/), and the
// list of shapes.
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

/// The geometric representation of an obstacle in contact and in the view. Three have closed forms, by the
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

/// Triangles and their placement: x -> place + rotation (scale x), in m.
struct PlacedSurface {
  std::shared_ptr<const TriangleMesh> mesh;  ///< null: not read yet
  Vec3 place{0, 0, 0};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 scale{1, 1, 1};
};

/// A point of an obstacle's surface.
struct SurfacePoint {
  Vec3 point;   ///< m
  Vec3 normal;  ///< outward, of length one
};

/// The functions of one shape. Precondition of all: the obstacle has this shape.
class ObstacleShape : public ShapeFacts {
 public:
  virtual ~ObstacleShape() = default;

  /// The parameters that only this shape has.
  virtual Fields<Obstacle> fields() const = 0;

  /// The member that holds its position (m): its pivot, which the view's handle moves.
  virtual Vec3& place(Obstacle& obstacle) const = 0;

  /// Fills in a new obstacle for a cloth with this middle and this largest length, in m.
  virtual void start(Obstacle& obstacle, const Vec3& middle, double span) const = 0;

  /// Bounding box in m, before any motion; empty if the shape is unbounded or its mesh has not been read.
  virtual Eigen::AlignedBox3d bounds(const Obstacle& obstacle) const = 0;

  /// The same in a pose.
  virtual Eigen::AlignedBox3d bounds_at(const Obstacle& obstacle, const Pose& pose) const;

  /// m, of its thinnest part; infinite if there is no other side, as with a half space.
  virtual double thickness(const Obstacle&) const { return infinity; }

  /// The stretch and the rotation that map `from` to `to`, about their pivots. Stretches of other
  /// bodies than boxes are the same along all axes.
  virtual Vec3 stretch_between(const Obstacle& from, const Obstacle& to) const = 0;
  virtual Eigen::Matrix3d rotation_between(const Obstacle&, const Obstacle&) const {
    return Eigen::Matrix3d::Identity();
  }

  /// The point of the surface nearest to a point inside (m); nullopt if the point is not inside, and for
  /// BodyKind::surface, which has no inside.
  virtual std::optional<SurfacePoint> penetration(const Obstacle&, const Vec3&) const { return {}; }

  /// Where a particle that moved from `from` to `point` inside the obstacle is placed on the surface.
  virtual std::optional<SurfacePoint> entry(const Obstacle& obstacle, const Vec3& from,
                                            const Vec3& point) const;

  /// The point nearest to `point`, which may be inside or outside, of the face that has this normal, continued
  /// beyond its edges; of a sphere, of the whole surface. nullopt for BodyKind::surface.
  virtual std::optional<SurfacePoint> along(const Obstacle&, const Vec3& normal, const Vec3& point) const;

  /// Moves the surface outward by `length` in m.
  virtual void grow(Obstacle&, double length) const;

  /// Whether the solid body in a pose touches a triangle. Not used for BodyKind::surface.
  virtual bool touches(const Obstacle&, const Pose&, const Corners& triangle) const;

  /// The triangles of BodyKind::surface, for contact and the view; none for other kinds.
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

/// The triangles of surface() in world coordinates, m. Precondition: the mesh has been read.
TriangleMesh placed_mesh(const Obstacle& obstacle);

/// The common part of the declarations of a position parameter.
ParameterInfo place_info(const char* key, const char* label, const char* doc);

// The shapes, a file each; the sphere, with which an obstacle begins, is declared in scene/scene.h.
const ObstacleShape& box_shape();
const ObstacleShape& plane_shape();
const ObstacleShape& mesh_shape();

}  // namespace cloth
