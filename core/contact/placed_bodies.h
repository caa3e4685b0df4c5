// Obstacles at rest where they are: the vertices of meshes and boxes and the planes of half spaces, which the
// pairs of a step ask for many times.
#pragma once

#include <vector>

#include "contact/obstacle_body.h"

namespace cloth {

class PlacedBodies {
 public:
  struct Plane {
    Vec3 normal{0, 0, 0};
    double level = 0;  ///< m, of the plane along its normal
  };

  /// A body is placed once its pose is that of the last call: one that moves would be placed in vain.
  /// `poses`: one for each body.
  void update(const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses);

  /// m, the body's vertices, to the bit as Pose::at() gives them; null: not placed. Valid until the next
  /// update().
  const Vec3* vertices(int body) const {
    return is_placed(body) ? kept_[index(body)].vertices.data() : nullptr;
  }
  /// Of a half space; null: not placed.
  const Plane* plane(int body) const { return is_placed(body) ? &kept_[index(body)].plane : nullptr; }

  static Plane place_plane(const ObstacleBody& body, const Pose& pose);

 private:
  struct Kept {
    Pose pose;
    bool is_placed = false;
    std::vector<Vec3> vertices;
    Plane plane;
  };

  static std::size_t index(int body) { return static_cast<std::size_t>(body); }
  bool is_placed(int body) const { return index(body) < kept_.size() && kept_[index(body)].is_placed; }

  std::vector<Kept> kept_;
};

}  // namespace cloth
