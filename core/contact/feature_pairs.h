// Narrow phase: a pair of a cloth feature (vertex, edge, face) and a feature of an obstacle or of the cloth
// itself, and the plane that separates them.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "contact/obstacle_body.h"

namespace cloth {

/// The cloth's feature is named first. Spheres pair with faces and planes with vertices, each as a whole; a
/// box pairs with vertices as a solid, with edges by its edges and with faces by its corners; a mesh and the
/// cloth itself by their features.
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
  int feature = 0;  ///< vertex, edge or face of the cloth, as `kind` says
  int foreign = 0;  ///< of the obstacle's mesh or box, or of the cloth itself
  auto operator<=>(const FeaturePair&) const = default;
};

/// Of the near feature, then of a far feature of the cloth itself.
struct PairParticles {
  int near_count = 0, count = 0;
  std::array<int, 4> particle{};
};

PairParticles particles_of(const FeaturePair& pair, const Surface& cloth);

/// The relative position of two convex features. Along the normal every point of the near feature is at
/// `near_level` or above and every point of the far one at `far_level` or below: where near_level > far_level
/// any plane between separates them, even if the closest points are inexact.
struct Separation {
  int near_count = 0,
      count = 0;  ///< particles: those of the near feature, then those of a far one of the cloth
  std::array<int, 4> particle{};
  std::array<double, 4>
      weight{};             ///< of the closest points: sum 1 on the near side, -1 on the far side if cloth
  Vec3 normal{0, 0, 0};     ///< from far to near, of length one; zero where the features meet
  Vec3 far_point{0, 0, 0};  ///< m, the closest one of an obstacle
  double distance = 0;      ///< m, between the closest points
  double near_level = 0, far_level = 0;  ///< m along the normal
  /// No neighbouring feature is closer, as far as this side can tell: the pair becomes a contact constraint.
  /// Others only bound the motion.
  bool nearest = false;

  double gap() const { return near_level - far_level; }
};

/// Positions in m; `poses` of the bodies, in their order. `nearest` is only determined up to the distance
/// `within`, in m.
Separation separate(const FeaturePair& pair, const Surface& cloth, const Vec3Field& position,
                    const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses, double within);

}  // namespace cloth
