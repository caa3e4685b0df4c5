// Narrow phase: a pair of a cloth feature (vertex, edge, face) and a feature of an obstacle or of the cloth
// itself, and the plane that separates them.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "contact/placed_bodies.h"

namespace cloth {

/// The cloth's feature is named first. The pairs of each kind of body: sphere: face_sphere; plane:
/// vertex_plane; box: vertex_box (the solid), edge_edge (its edges) and face_vertex (its corners); mesh and
/// the cloth itself: vertex_face, edge_edge and face_vertex.
enum class PairKind : std::uint8_t {
  vertex_plane,
  vertex_box,
  face_sphere,
  vertex_face,
  edge_edge,
  face_vertex
};

struct FeaturePair {
  static constexpr int cloth_itself = -1;

  int obstacle = cloth_itself;
  PairKind kind = PairKind::vertex_plane;
  int feature = 0;      ///< vertex, edge or face of the cloth, as `kind` says
  int far_feature = 0;  ///< feature of the obstacle's mesh or box, or the second one of the cloth itself
  auto operator<=>(const FeaturePair&) const = default;
};

/// The particles of the near feature, then those of the far feature if it belongs to the cloth as well.
struct PairParticles {
  int near_count = 0, count = 0;
  std::array<int, 4> particle{};
};

PairParticles particles_of(const FeaturePair& pair, const Surface& cloth);

/// The relative position of two convex features. Along the normal every point of the near feature is at
/// `near_level` or above and every point of the far one at `far_level` or below: where near_level > far_level
/// any plane between separates them, even if the closest points are inexact.
struct Separation : PairParticles {
  /// Of the closest points: sum 1 on the near side, and -1 on the far side if that is cloth.
  std::array<double, 4> weight{};
  Vec3 normal{0, 0, 0};     ///< unit vector from far to near; zero where the features have a common point
  Vec3 far_point{0, 0, 0};  ///< m, the closest point of the far feature
  double distance = 0;      ///< m, between the closest points
  double near_level = 0, far_level = 0;  ///< m along the normal
  /// No neighbouring feature is closer: the pair becomes a contact constraint. Others only bound the motion.
  bool nearest = false;

  double gap() const { return near_level - far_level; }
};

/// Where the features of pairs are.
struct PairSetting {
  const Surface& cloth;
  const Vec3Field& position;  ///< m, of the cloth's particles
  const std::vector<ObstacleBody>& bodies;
  const std::vector<Pose>& poses;        ///< one for each body
  const PlacedBodies* placed = nullptr;  ///< in these poses

  /// Null: not placed.
  const Vec3* placed_vertices(int obstacle) const { return placed ? placed->vertices(obstacle) : nullptr; }
  PlacedBodies::Plane plane(int obstacle) const {
    const PlacedBodies::Plane* kept = placed ? placed->plane(obstacle) : nullptr;
    const auto k = static_cast<std::size_t>(obstacle);
    return kept ? *kept : PlacedBodies::place_plane(bodies[k], poses[k]);
  }
};

/// `nearest` is only determined for pairs closer than `within`, in m.
Separation separate(const FeaturePair& pair, const PairSetting& setting, double within);

// The parts of separate(), for those who find the closest points of many pairs at once (separations.h).

/// m: the ends of the cloth's edge and of the far one, or a point and a triangle's vertices.
using FeaturePoints = std::array<Vec3, 4>;

enum class PairShape { segments, point_and_triangle, point_and_solid };

inline PairShape shape_of(PairKind kind) {
  if (kind == PairKind::edge_edge) return PairShape::segments;
  return kind == PairKind::vertex_plane || kind == PairKind::vertex_box ? PairShape::point_and_solid
                                                                        : PairShape::point_and_triangle;
}

/// Precondition of these: no solid.
FeaturePoints points_of(const FeaturePair& pair, const PairSetting& setting);
Separation separation_of(const FeaturePair& pair, const FeaturePoints& points, const SegmentSegment& closest,
                         const PairSetting& setting, double within);
Separation separation_of(const FeaturePair& pair, const FeaturePoints& points, const PointTriangle& closest,
                         const PairSetting& setting, double within);
/// False where these closest points are those of another pair as well, which holds them: this one is not
/// `nearest` then.
bool is_in_charge(const SegmentSegment& closest);
bool is_in_charge(const FeaturePair& pair, const PointTriangle& closest, const PairSetting& setting);
/// m, from that of the closest points.
double distance_of(const FeaturePair& pair, double squared_distance, const PairSetting& setting);

}  // namespace cloth
