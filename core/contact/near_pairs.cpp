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

template <class Region>
Region region_in(const Capsule& capsule) {
  if constexpr (std::is_same_v<Region, Ball>)
    return {capsule.from, capsule.radius};
  else
    return capsule;
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
    for (const Capsule& capsule : swept.particles) are_balls_ = are_balls_ && capsule.from == capsule.to;
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
    if (are_balls_)
      find_own_of(search_.balls_);
    else
      find_own_of(search_.capsules_);
  }

 private:
  template <class Region>
  void find_own_of(std::vector<Region>& near) {
    near.clear();
    for (const Capsule& capsule : swept_.particles)
      near.push_back(region_in<Region>(capsule).grown(0.5 * swept_.own_reach));
    std::vector<Slab>& faces = search_.own_faces_;
    faces.resize(cloth_.triangles.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto& [a, b, c] = cloth_.triangles[f];
      faces[f] = slab_of(near[at(a)], near[at(b)], near[at(c)]);
    }
    std::vector<RoundedBox>& boxes = search_.own_boxes_;
    boxes.clear();
    for (const Slab& face : faces) boxes.emplace_back(face.box);
    std::vector<Bounds>& edges = search_.own_edges_;
    edges.clear();
    for (const auto& [a, b] : cloth_.edges)
      edges.push_back(bounds_of(box_of(near[at(a)]), box_of(near[at(b)])));
    find_faces<Region, Region>(
        search_.own_overlaps_,
        {FeaturePair::cloth_itself, cloth_, near, {cloth_, near, faces, boxes, edges}});
  }

  /// The regions of the particles in the coordinates of an obstacle at rest, grown by the reach.
  template <class Region>
  const std::vector<Region>& seen(const PoseInterpolation& path, std::vector<Region>& regions) const {
    regions.clear();
    const Pose& pose = path.from();
    for (const Capsule& capsule : swept_.particles)
      regions.push_back(region_in<Region>({pose.inverse(capsule.from), pose.inverse(capsule.to),
                                           (capsule.radius + reach_) / path.least_stretch()}));
    return regions;
  }
  /// Boxes around them, for the whole path of an obstacle.
  const std::vector<Bounds>& seen_boxes(const ObstacleBody& body, const PoseInterpolation& path) {
    std::vector<Bounds>& boxes = search_.seen_;
    if (path.is_still()) {
      boxes.clear();
      for (const Capsule& capsule : seen(path, search_.capsules_)) boxes.push_back(box_of(capsule));
    } else {
      seen_from_body(body, path, particles_, reach_, boxes);
    }
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
      if (lowest < reach_) add(PairKind::vertex_plane, static_cast<int>(i), 0);
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
    const std::vector<BoxPair>& overlaps = search_.mesh_overlaps_[at(obstacle_)];
    const FacesInRegions<Vec3> far{body.surface, body.vertices, search_.mesh_faces_[at(obstacle_)],
                                   search_.mesh_boxes_[at(obstacle_)], search_.mesh_edges_[at(obstacle_)]};
    const auto find_near = [&]<class Region>(const std::vector<Region>& near) {
      find_faces<Region, Vec3>(overlaps, {obstacle_, cloth_, near, far});
    };
    if (!path.is_still())
      find_near(seen_boxes(body, path));
    else if (are_balls_)
      find_near(seen(path, search_.balls_));
    else
      find_near(seen(path, search_.capsules_));
  }

  template <class NearRegion, class FarRegion>
  void find_faces(const std::vector<BoxPair>& overlaps, const FacePairFinder<NearRegion, FarRegion>& finder) {
    search_.in_parts(overlaps.size(), least_share, search_.pair_parts_, pairs_,
                     [&](std::size_t begin, std::size_t end, std::vector<FeaturePair>& part) {
                       auto own_finder = finder;
                       own_finder.find(std::span(overlaps).subspan(begin, end - begin), part);
                     });
  }

  PairSearch& search_;
  const Surface& cloth_;
  const std::vector<Bounds>& particles_;
  const SweptBounds& swept_;
  double reach_;
  std::vector<FeaturePair>& pairs_;
  Bounds whole_;
  bool are_balls_ = true;           ///< the particles' regions
  std::vector<unsigned> outcodes_;  ///< of the particles' boxes
  int obstacle_ = FeaturePair::cloth_itself;
};

PairSearch::PairSearch(const Surface& cloth, const Vec3Field& start, const std::vector<ObstacleBody>& bodies,
                       bool with_itself, double skin)
    : cloth_(cloth),
      bodies_(bodies),
      with_itself_(with_itself),
      skin_(skin),
      mesh_faces_(bodies.size()),
      mesh_boxes_(bodies.size()),
      mesh_edges_(bodies.size()),
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
      mesh_boxes_[k].emplace_back(boxes.back());
    }
    for (const auto& [a, b] : bodies[k].surface.edges)
      mesh_edges_[k].push_back(bounds_of(vertices[at(a)], vertices[at(b)]));
    mesh_trees_[k] = BoxTree(boxes);
  }
  if (!with_itself_) return;
  needs_trees_ = true;
  bound_faces(start, 0);
  cloth_tree_ = BoxTree(faces_);
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
    cloth_tree_.refit(faces_);
    own_overlaps_.clear();
    in_parts(faces_.size(), least_queries, overlap_parts_, own_overlaps_,
             [&](std::size_t begin, std::size_t end, std::vector<BoxPair>& part) {
               cloth_tree_.collect_own(begin, end, part);
               std::erase_if(part, [&](const BoxPair& faces) {
                 return !have_own_pairs(cloth_, faces.query, faces.index);
               });
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
               std::erase_if(part, [&](const BoxPair& faces) {
                 return !have_pairs(cloth_, faces.query, bodies_[k].surface, faces.index);
               });
             });
  }
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
  return cloth_tree_.depth();
}

void PairSearch::append_boxes(int body, int level, const Vec3Field& position, double reach,
                              std::vector<Bounds>& boxes) {
  if (body != FeaturePair::cloth_itself) return mesh_trees_[at(body)].append_rounded_boxes(level, boxes);
  if (!with_itself_) return;
  bound_faces(position, reach);
  cloth_tree_.refit(faces_);
  cloth_tree_.append_rounded_boxes(level, boxes);
}

}  // namespace cloth
