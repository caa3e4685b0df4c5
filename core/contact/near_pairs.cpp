#include "contact/near_pairs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/face_pair_finder.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// Overlaps, and faces to be looked for in a hierarchy, that are worth a thread of their own.
constexpr std::size_t least_share = 1000, least_queries = 200;

/// m, largest distance of an arc from its chord, for a point that rotates at `radius` metres from the axis.
double bulge(const PoseInterpolation& path, double radius) {
  if (path.angle() >= 2 * std::numbers::pi) return 2 * radius;
  return radius * (1 - std::cos(0.5 * path.angle()));
}

/// The same for a point at rest, `radius` metres from the pivot at the start, in the obstacle's coordinates:
/// the displacement of the pivot rotates too, and deviates from the chord by t (1 - t) times the angle.
double seen_bulge(const PoseInterpolation& path, double radius) {
  return bulge(path, radius) + 0.25 * path.angle() * (path.pivot(1) - path.pivot(0)).norm();
}

/// A box around the path of a point of an obstacle, grown by `reach`. A point that rotates and whose distance
/// from the pivot changes deviates from the chord by at most an eighth of the second derivative.
Bounds swept_box(const PoseInterpolation& path, const Vec3& pivot, const Vec3& point, double reach) {
  const double radius = (point - pivot).norm();
  return bounds_of(path.from().at(point), path.to().at(point))
      .grown(reach + bulge(path, path.largest_stretch() * radius) +
             0.25 * path.angle() * path.growth() * radius);
}

/// A bounding box in the coordinates of an obstacle.
Bounds seen_from(const Pose& pose, const Bounds& box) {
  const Vec3 middle = pose.inverse(0.5 * (box.lower + box.upper));
  const Vec3 half = pose.rotation.cwiseAbs().transpose() * (0.5 * (box.upper - box.lower));
  return {middle - half.cwiseQuotient(pose.stretch), middle + half.cwiseQuotient(pose.stretch)};
}

/// Boxes of the cloth in the coordinates of a mesh, for its whole path, grown by `reach`.
void seen_from_body(const ObstacleBody& body, const PoseInterpolation& path, const std::vector<Bounds>& boxes,
                    double reach, std::vector<Bounds>& seen) {
  const Vec3 pivot = path.from().at(body.pivot);
  const bool at_home = path.is_still() && path.from() == Pose{};
  seen.resize(boxes.size());
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const Bounds& box = boxes[f];
    seen[f] = at_home ? box : seen_from(path.from(), box);
    if (!path.is_still()) seen[f].add(seen_from(path.to(), box));
    const double radius = (0.5 * (box.lower + box.upper) - pivot).norm() + (box.upper - box.lower).norm();
    seen[f] = seen[f].grown((reach + seen_bulge(path, radius)) / path.least_stretch());
  }
}

bool holds(const Bounds& outer, const Bounds& inner) {
  return (outer.lower.array() <= inner.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

}  // namespace

/// fill(begin, end, part) for shares of [0, count); appends the parts in their order.
template <class Part, class Fill>
void PairSearch::in_parts(std::size_t count, std::size_t least, std::vector<std::vector<Part>>& parts,
                          std::vector<Part>& whole, const Fill& fill) {
  const int shares = in_shares(team_, count, least, [&](int share, std::size_t begin, std::size_t end) {
    parts[at(share)].clear();
    fill(begin, end, parts[at(share)]);
  });
  for (int share = 0; share < shares; ++share)
    whole.insert(whole.end(), parts[at(share)].begin(), parts[at(share)].end());
}

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

  void find_own() {
    std::vector<Capsule>& near = search_.seen_capsules_;
    near.clear();
    for (const Capsule& capsule : swept_.particles) near.push_back(capsule.grown(0.5 * swept_.own_reach));
    std::vector<Slab>& faces = search_.own_faces_;
    faces.resize(cloth_.triangles.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto& [a, b, c] = cloth_.triangles[f];
      faces[f] = slab_of(near[at(a)], near[at(b)], near[at(c)]);
    }
    find_faces<Capsule, Capsule>(search_.own_overlaps_,
                                 {FeaturePair::cloth_itself, cloth_, near, cloth_, near, faces});
  }

 private:
  Bounds box_of_edge(int edge) const {
    const auto& [a, b] = cloth_.edges[at(edge)];
    return bounds_of(particles_[at(a)], particles_[at(b)]);
  }
  Bounds box_of_face(int face) const {
    const auto& [a, b, c] = cloth_.triangles[at(face)];
    return bounds_of(particles_[at(a)], particles_[at(b)], particles_[at(c)]);
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
      if (lowest < reach_) add(PairKind::vertex_plane, static_cast<int>(i), 0);
    }
  }

  void find_sphere(const ObstacleBody& body, const PoseInterpolation& path) {
    const double radius = path.largest_stretch() * body.radius;
    const Bounds box_of_path = swept_box(path, body.pivot, body.center, reach_ + radius);
    if (!overlap(whole_, box_of_path)) return;
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f)
      if (overlap(box_of_face(f), box_of_path)) add(PairKind::face_sphere, f, 0);
  }

  void find_box(const ObstacleBody& body, const PoseInterpolation& path) {
    Bounds box_of_path;
    std::array<Bounds, 8> corner;
    for (std::size_t k = 0; k < 8; ++k) {
      corner[k] = swept_box(path, body.pivot, body.vertices[k], reach_);
      box_of_path.add(corner[k]);
    }
    if (!overlap(whole_, box_of_path)) return;
    for (std::size_t i = 0; i < particles_.size(); ++i)
      if (overlap(particles_[i], box_of_path)) add(PairKind::vertex_box, static_cast<int>(i), 0);
    for (int e = 0; e < static_cast<int>(cloth_.edges.size()); ++e) {
      const Bounds box = box_of_edge(e);
      if (!overlap(box, box_of_path)) continue;
      for (std::size_t k = 0; k < 12; ++k)
        if (overlap(box, bounds_of(corner[at(box_edges[k][0])], corner[at(box_edges[k][1])])))
          add(PairKind::edge_edge, e, static_cast<int>(k));
    }
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f) {
      const Bounds box = box_of_face(f);
      if (!overlap(box, box_of_path)) continue;
      for (std::size_t k = 0; k < 8; ++k)
        if (overlap(box, corner[k])) add(PairKind::face_vertex, f, static_cast<int>(k));
    }
  }

  void find_mesh(const ObstacleBody& body, const PoseInterpolation& path) {
    const std::vector<BoxPair>& overlaps = search_.mesh_overlaps_[at(obstacle_)];
    const std::vector<Slab>& faces = search_.mesh_faces_[at(obstacle_)];
    if (path.is_still()) {
      std::vector<Capsule>& near = search_.seen_capsules_;
      near.clear();
      const Pose& pose = path.from();
      for (const Capsule& capsule : swept_.particles)
        near.push_back({pose.inverse(capsule.from), pose.inverse(capsule.to),
                        (capsule.radius + reach_) / path.least_stretch()});
      find_faces<Capsule, Vec3>(overlaps, {obstacle_, cloth_, near, body.surface, body.vertices, faces});
    } else {
      std::vector<Bounds>& near = search_.seen_;
      seen_from_body(body, path, particles_, reach_, near);
      find_faces<Bounds, Vec3>(overlaps, {obstacle_, cloth_, near, body.surface, body.vertices, faces});
    }
  }

  template <class NearRegion, class FarRegion>
  void find_faces(const std::vector<BoxPair>& overlaps, const FacePairFinder<NearRegion, FarRegion>& finder) {
    search_.in_parts(overlaps.size(), least_share, search_.pair_parts_, pairs_,
                     [&](std::size_t begin, std::size_t end, std::vector<FeaturePair>& part) {
                       auto own_finder = finder;
                       for (std::size_t k = begin; k < end; ++k)
                         own_finder.find(overlaps[k].query, overlaps[k].index, part);
                     });
  }

  PairSearch& search_;
  const Surface& cloth_;
  const std::vector<Bounds>& particles_;
  const SweptBounds& swept_;
  double reach_;
  std::vector<FeaturePair>& pairs_;
  Bounds whole_;
  int obstacle_ = FeaturePair::cloth_itself;
};

PairSearch::PairSearch(const Surface& cloth, const std::vector<ObstacleBody>& bodies, bool with_itself,
                       double skin)
    : cloth_(cloth),
      bodies_(bodies),
      with_itself_(with_itself),
      skin_(skin),
      mesh_faces_(bodies.size()),
      mesh_trees_(bodies.size()),
      mesh_overlaps_(bodies.size()) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].kind != BodyKind::surface) continue;
    needs_trees_ = true;
    const std::vector<Vec3>& vertices = bodies[k].vertices;
    std::vector<Bounds> boxes;
    for (const auto& [a, b, c] : bodies[k].surface.triangles) {
      mesh_faces_[k].push_back(slab_of(vertices[at(a)], vertices[at(b)], vertices[at(c)]));
      boxes.push_back(mesh_faces_[k].back().box);
    }
    mesh_trees_[k] = BoxTree(boxes);
  }
  needs_trees_ = needs_trees_ || with_itself_;
}

void PairSearch::set_team(WorkerTeam* team) {
  team_ = team;
  const std::size_t threads = team ? static_cast<std::size_t>(team->size()) : 1;
  pair_parts_.resize(threads), overlap_parts_.resize(threads);
}

/// `particles`: regions or positions.
template <class Regions>
void PairSearch::bound_faces(const Regions& particles, double reach) {
  faces_.resize(cloth_.triangles.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto& [a, b, c] = cloth_.triangles[f];
    faces_[f] = bounds_of(particles[at(a)], particles[at(b)], particles[at(c)]).grown(reach);
  }
}

/// The overlaps that the trees have found are reused while every particle stays in its grown box and no mesh
/// moves. They may be too many; the later tests use the bounds of this step, so that the pairs do not depend
/// on the cache.
void PairSearch::find_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths) {
  const auto stays = [&](std::size_t i) { return holds(cached_[i], particles_[i]); };
  bool kept = cached_.size() == particles_.size() && cached_reach_ == swept.reach;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    kept = kept && (bodies_[k].kind != BodyKind::surface ||
                    (paths[k].is_still() && paths[k].to() == cached_poses_[k]));
  for (std::size_t i = 0; kept && i < particles_.size(); ++i) kept = stays(i);
  if (kept) return;

  cached_reach_ = swept.reach;
  cached_.resize(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) cached_[i] = particles_[i].grown(skin_);
  cached_poses_.clear();
  for (const PoseInterpolation& path : paths) cached_poses_.push_back(path.to());
  if (with_itself_) {
    bound_faces(cached_, 0.5 * swept.own_reach);
    refit_cloth();
    own_overlaps_.clear();
    in_parts(faces_.size(), least_queries, overlap_parts_, own_overlaps_,
             [&](std::size_t begin, std::size_t end, std::vector<BoxPair>& part) {
               cloth_tree_.collect_own(begin, end, part);
             });
  }
  bound_faces(cached_, 0);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].kind != BodyKind::surface) continue;
    seen_from_body(bodies_[k], paths[k], faces_, swept.reach, seen_);
    mesh_overlaps_[k].clear();
    in_parts(seen_.size(), least_queries, overlap_parts_, mesh_overlaps_[k],
             [&](std::size_t begin, std::size_t end, std::vector<BoxPair>& part) {
               mesh_trees_[k].collect(seen_, begin, end, part);
             });
  }
}

void PairSearch::refit_cloth() {
  if (cloth_tree_.size() == 0)
    cloth_tree_ = BoxTree(faces_);
  else
    cloth_tree_.refit(faces_);
}

void PairSearch::find(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths,
                      std::vector<FeaturePair>& pairs) {
  pairs.clear();
  particles_.clear();
  for (const Capsule& capsule : swept.particles) particles_.push_back(box_of(capsule));
  if (needs_trees_) find_overlaps(swept, paths);
  Step step(*this, swept, pairs);
  if (with_itself_) step.find_own();
  for (std::size_t k = 0; k < bodies_.size(); ++k) step.find(static_cast<int>(k), paths[k]);
}

int PairSearch::hierarchy_depth(int body) const {
  if (body != FeaturePair::cloth_itself) return mesh_trees_[at(body)].depth();
  if (!with_itself_) return 0;
  if (cloth_tree_.size() > 0) return cloth_tree_.depth();
  return BoxTree::depth_of(cloth_.triangles.size());
}

void PairSearch::append_boxes(int body, int level, const Vec3Field& position, double reach,
                              std::vector<Bounds>& boxes) {
  if (body != FeaturePair::cloth_itself) return mesh_trees_[at(body)].append_rounded_boxes(level, boxes);
  if (!with_itself_) return;
  bound_faces(position, reach);
  refit_cloth();
  cloth_tree_.append_rounded_boxes(level, boxes);
}

}  // namespace cloth
