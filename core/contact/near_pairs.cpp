#include "contact/near_pairs.h"

#include <algorithm>
#include <array>

#include "contact/particle_motion.h"
#include "contact/seen_boxes.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {

/// One search.
class PairSearch::Step {
 public:
  Step(PairSearch& search, const SweptBounds& swept, std::vector<FeaturePair>& pairs)
      : search_(search),
        cloth_(search.cloth_),
        particles_(search.particles_),
        swept_(swept),
        reach_(swept.reach),
        pairs_(pairs) {
    for (const Bounds& box : particles_) whole_.add(box);
  }

  void find(int obstacle, const PoseInterpolation& path) {
    obstacle_ = obstacle;
    const ObstacleBody& body = search_.bodies_[at(obstacle)];
    switch (body.kind) {
      case BodyKind::half_space:
        return find_plane(body, path);
      case BodyKind::ball:
        return find_sphere(body, path);
      case BodyKind::box:
        return find_box(body, path);
      case BodyKind::surface:
        return find_mesh(body, path);
    }
  }

  /// Pairs of the cloth itself, each side grown by half the reach.
  void find_own() {
    of_particles(search_.near_, [&](std::size_t i) {
      return rounded(Capsule{swept_.from[i], swept_.to[i], swept_.radius[i] + 0.5 * swept_.own_reach});
    });
    search_.own_->find(search_.near_, search_.skin_, search_.team_, pairs_);
  }

 private:
  template <class T, class Value>
  void of_particles(std::vector<T>& values, const Value& value) {
    fill_in_shares(search_.team_, swept_.size(), least_particles, values, value);
  }
  /// Boxes of the particles in the coordinates of an obstacle, for its whole path, grown by the reach.
  const std::vector<Bounds>& seen_boxes(const ObstacleBody& body, const PoseInterpolation& path) {
    std::vector<Bounds>& boxes = search_.seen_;
    if (!path.is_still()) {
      seen_from_body(body, path, particles_, reach_, boxes);
      return boxes;
    }
    of_particles(boxes, [&](std::size_t i) { return box_of(seen_at_rest(path, swept_[i], reach_)); });
    return boxes;
  }
  void find_outcodes(const std::vector<Bounds>& particles, const Bounds& box) {
    outcodes_.resize(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) outcodes_[i] = outcode(particles[i], box);
  }
  /// Whether the box of these particles lies beyond a side of the box of the outcodes.
  template <class Particles>
  bool are_outside(const Particles& particles) const {
    unsigned common = ~0U;
    for (const int i : particles) common &= outcodes_[at(i)];
    return common != 0;
  }
  void add(PairKind kind, int feature, int far_feature) {
    pairs_.push_back({obstacle_, kind, feature, far_feature});
  }

  void find_plane(const ObstacleBody& body, const PoseInterpolation& path) {
    const Vec3 pivot = path.from().at(body.pivot);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const Vec3 middle = 0.5 * (particles_[i].lower + particles_[i].upper);
      const Vec3 half = 0.5 * (particles_[i].upper - particles_[i].lower);
      double lowest = infinity;
      for (const Pose* pose : {&path.from(), &path.to()}) {
        const Vec3 normal = pose->rotation * body.normal;
        lowest = std::min(lowest, normal.dot(middle - pose->at(body.point)) - normal.cwiseAbs().dot(half));
      }
      if (path.angle() > 0) lowest -= seen_bulge(path, (middle - pivot).norm() + half.norm());
      if (lowest <= reach_) add(PairKind::vertex_plane, static_cast<int>(i), 0);
    }
  }

  void find_sphere(const ObstacleBody& body, const PoseInterpolation& path) {
    const double radius = path.largest_stretch() * body.radius;
    const Bounds box_of_path = swept_box(path, body.pivot, body.center, reach_ + radius);
    if (!overlap(whole_, box_of_path)) return;
    find_outcodes(particles_, box_of_path);
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f)
      if (!are_outside(cloth_.triangles[at(f)])) add(PairKind::face_sphere, f, 0);
  }

  /// In the coordinates of the box, along whose axes its edges lie.
  void find_box(const ObstacleBody& body, const PoseInterpolation& path) {
    if (!comes_near(body, path, whole_, reach_)) return;
    const std::vector<Bounds>& near = seen_boxes(body, path);
    const std::vector<Vec3>& corners = body.vertices;
    find_outcodes(near, {body.box.center - body.box.half, body.box.center + body.box.half});
    std::array<Bounds, 12> edges;
    for (std::size_t k = 0; k < edges.size(); ++k)
      edges[k] = bounds_of(corners[at(box_edges[k][0])], corners[at(box_edges[k][1])]);
    for (std::size_t i = 0; i < near.size(); ++i)
      if (outcodes_[i] == 0) add(PairKind::vertex_box, static_cast<int>(i), 0);
    for (int e = 0; e < static_cast<int>(cloth_.edges.size()); ++e) {
      const auto& [a, b] = cloth_.edges[at(e)];
      if (are_outside(cloth_.edges[at(e)])) continue;
      const Bounds box = bounds_of(near[at(a)], near[at(b)]);
      for (std::size_t k = 0; k < edges.size(); ++k)
        if (overlap(box, edges[k])) add(PairKind::edge_edge, e, static_cast<int>(k));
    }
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f) {
      const auto& [a, b, c] = cloth_.triangles[at(f)];
      if (are_outside(cloth_.triangles[at(f)])) continue;
      const Bounds box = bounds_of(near[at(a)], near[at(b)], near[at(c)]);
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (overlap(box, bounds_of(corners[k]))) add(PairKind::face_vertex, f, static_cast<int>(k));
    }
  }

  void find_mesh(const ObstacleBody& body, const PoseInterpolation& path) {
    if (path.is_still()) {
      of_particles(search_.near_,
                   [&](std::size_t i) { return rounded(seen_at_rest(path, swept_[i], reach_)); });
    } else {
      const std::vector<Bounds>& boxes = seen_boxes(body, path);
      of_particles(search_.near_, [&](std::size_t i) { return rounded(boxes[i]); });
    }
    search_.meshes_[at(obstacle_)]->find(search_.near_, search_.skin_ / path.least_stretch(), search_.team_,
                                         pairs_);
  }

  PairSearch& search_;
  const Surface& cloth_;
  const std::vector<Bounds>& particles_;
  const SweptBounds& swept_;
  double reach_;
  std::vector<FeaturePair>& pairs_;
  Bounds whole_;
  std::vector<unsigned> outcodes_;  ///< of the particles' boxes
  int obstacle_ = FeaturePair::cloth_itself;
};

PairSearch::PairSearch(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
                       bool with_itself, double skin)
    : cloth_(cloth), bodies_(bodies), skin_(skin), meshes_(bodies.size()) {
  if (with_itself) own_.emplace(cloth_, start);
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (bodies[k].kind == BodyKind::surface) meshes_[k].emplace(cloth_, static_cast<int>(k), bodies[k]);
}

void PairSearch::find(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths,
                      std::vector<FeaturePair>& pairs) {
  pairs.clear();
  fill_in_shares(team_, swept.size(), least_particles, particles_,
                 [&](std::size_t i) { return box_of(swept[i]); });
  Step step(*this, swept, pairs);
  if (own_) step.find_own();
  for (std::size_t k = 0; k < bodies_.size(); ++k) step.find(static_cast<int>(k), paths[k]);
}

int PairSearch::hierarchy_depth(int body) const {
  const std::optional<RegionOverlaps>& overlaps =
      body == FeaturePair::cloth_itself ? own_ : meshes_[at(body)];
  return overlaps ? overlaps->hierarchy().depth() : 0;
}

void PairSearch::append_boxes(int body, int level, const Vec3Field& position, double reach,
                              std::vector<Bounds>& boxes) {
  std::optional<RegionOverlaps>& overlaps = body == FeaturePair::cloth_itself ? own_ : meshes_[at(body)];
  if (!overlaps) return;
  if (body == FeaturePair::cloth_itself) overlaps->refit_hierarchy(position, reach);
  overlaps->hierarchy().append_rounded_boxes(level, boxes);
}

}  // namespace cloth
