#include "contact/placed_bodies.h"

namespace cloth {

PlacedBodies::Plane PlacedBodies::place_plane(const ObstacleBody& body, const Pose& pose) {
  const Vec3 normal = pose.rotation * body.normal;
  return {normal, normal.dot(pose.at(body.point))};
}

void PlacedBodies::update(const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses) {
  const bool is_first = kept_.size() != bodies.size();
  kept_.resize(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    Kept& kept = kept_[k];
    if (is_first || !(kept.pose == poses[k])) {
      kept.pose = poses[k], kept.is_placed = false;
    } else if (!kept.is_placed) {
      kept.vertices.clear();
      for (const Vec3& vertex : bodies[k].vertices) kept.vertices.push_back(kept.pose.at(vertex));
      kept.plane = place_plane(bodies[k], kept.pose);
      kept.is_placed = true;
    }
  }
}

}  // namespace cloth
