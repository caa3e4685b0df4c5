#include "contact/near_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "contact/seen_boxes.h"
#include "geometry/at.h"
#include "kernels/in_shares.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

/// Overlaps, of up to eight features each, and features to be looked for in a hierarchy, that are worth a
/// thread of their own.
constexpr std::size_t least_share = 100, least_queries = 64;

bool has_vertex(const Triangle& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

bool share_vertex(const std::array<int, 2>& edge, const std::array<int, 2>& other) {
  return edge[0] == other[0] || edge[0] == other[1] || edge[1] == other[0] || edge[1] == other[1];
}

/// Of eight places of an order, `hits` without those of features for which is_out(feature).
template <class IsOut>
std::uint32_t without(std::uint32_t hits, int eight, std::span<const int> order, const IsOut& is_out) {
  const auto first = at(eight) * EightBoxes::count;
  for (std::uint32_t left = hits; left != 0; left &= left - 1)
    if (is_out(order[first + static_cast<std::size_t>(std::countr_zero(left))]))
      hits &= ~(left & (~left + 1));
  return hits;
}

/// Throws std::length_error where RegionOverlap cannot count so many features.
void expect_to_be_counted(std::size_t features) {
  if (features / EightBoxes::count >= std::size_t{1} << RegionOverlap::most_bits)
    throw std::length_error("more than 134 million features of a surface in contact");
}

bool holds(const Bounds& outer, const Bounds& inner) {
  return (outer.lower.array() <= inner.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

}  // namespace

Feature PairSearch::Meeting::near() const {
  if (kind == PairKind::edge_edge) return Feature::edge;
  return kind == PairKind::vertex_face ? Feature::vertex : Feature::face;
}

Feature PairSearch::Meeting::far() const {
  if (kind == PairKind::edge_edge) return Feature::edge;
  return kind == PairKind::vertex_face ? Feature::face : Feature::vertex;
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

  /// Pairs of the cloth itself, each side grown by half the reach.
  void find_own() {
    std::vector<RoundedRegion>& near = search_.near_;
    near.clear();
    for (const Capsule& capsule : swept_.particles)
      near.push_back(rounded({capsule.from, capsule.to, capsule.radius + 0.5 * swept_.own_reach}));
    for (const Feature feature : {Feature::edge, Feature::face})
      fill(search_.own_regions_[feature], cloth_, feature, search_.own_trees_[feature].order(), near);
    take_near(search_.own_regions_);
  }

 private:
  void take_near(const OfFeatures<Regions>& far) {
    for (const Meeting& meeting : search_.meetings_)
      if (meeting.obstacle == obstacle_) search_.take_near(meeting, far[meeting.far()], pairs_);
  }

  /// Boxes of the particles in the coordinates of an obstacle, for its whole path, grown by the reach.
  const std::vector<Bounds>& seen_boxes(const ObstacleBody& body, const PoseInterpolation& path) {
    std::vector<Bounds>& boxes = search_.boxes_[Feature::vertex];
    if (!path.is_still()) {
      seen_from_body(body, path, particles_, reach_, boxes);
      return boxes;
    }
    boxes.clear();
    for (const Capsule& capsule : swept_.particles)
      boxes.push_back(box_of(seen_at_rest(path, capsule, reach_)));
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
    std::vector<RoundedRegion>& near = search_.near_;
    near.clear();
    if (path.is_still())
      for (const Capsule& capsule : swept_.particles)
        near.push_back(rounded(seen_at_rest(path, capsule, reach_)));
    else
      for (const Bounds& box : seen_boxes(body, path)) near.push_back(rounded(box));
    take_near(search_.mesh_regions_[at(obstacle_)]);
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
    : cloth_(cloth),
      bodies_(bodies),
      with_itself_(with_itself),
      skin_(skin),
      mesh_trees_(bodies.size()),
      mesh_regions_(bodies.size()) {
  if (with_itself_) {
    for (std::size_t i = 0; i < start.size(); ++i) boxes_[Feature::vertex].push_back(bounds_of(start[i]));
    spread(cloth_, boxes_);
    for (const Feature feature : {Feature::edge, Feature::face})
      expect_to_be_counted(boxes_[feature].size()), own_trees_[feature] = BoxTree(boxes_[feature]);
    meetings_.push_back({.kind = PairKind::edge_edge});
    meetings_.push_back({.kind = PairKind::vertex_face});
  }
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].kind != BodyKind::surface) continue;
    boxes_[Feature::vertex].clear();
    std::vector<RoundedRegion> vertices;
    for (const Vec3& vertex : bodies[k].vertices) {
      boxes_[Feature::vertex].push_back(bounds_of(vertex));
      vertices.push_back(rounded(Capsule{vertex, vertex}));
    }
    spread(bodies[k].surface, boxes_);
    for (const Feature feature : {Feature::vertex, Feature::edge, Feature::face}) {
      mesh_trees_[k][feature] = BoxTree(boxes_[feature]);
      expect_to_be_counted(boxes_[feature].size());
      fill(mesh_regions_[k][feature], bodies[k].surface, feature, mesh_trees_[k][feature].order(), vertices);
    }
    for (const PairKind kind : {PairKind::edge_edge, PairKind::vertex_face, PairKind::face_vertex})
      meetings_.push_back({.obstacle = static_cast<int>(k), .kind = kind});
  }
}

void PairSearch::set_team(WorkerTeam* team) {
  team_ = team;
  parts_.resize(std::max(parts_.size(), team ? static_cast<std::size_t>(team->size()) : 1));
}

/// The overlaps that the trees have found are reused while every particle stays in its grown box and no mesh
/// moves. They may be too many; the later tests use the bounds of this step, so that the pairs do not depend
/// on the cache.
bool PairSearch::keeps_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths) const {
  if (cached_.size() != particles_.size() || cached_poses_.size() != paths.size() ||
      cached_reach_ != swept.reach || cached_own_reach_ != swept.own_reach)
    return false;
  for (const Meeting& meeting : meetings_) {
    if (meeting.obstacle == FeaturePair::cloth_itself) continue;
    const PoseInterpolation& path = paths[at(meeting.obstacle)];
    if (!path.is_still() || path.to() != cached_poses_[at(meeting.obstacle)]) return false;
  }
  const double of_rounding = 0.01 * skin_;  // of boxes in single precision
  for (std::size_t i = 0; i < particles_.size(); ++i)
    if (!holds(cached_[i], particles_[i].grown(of_rounding))) return false;
  return true;
}

void PairSearch::find_overlaps(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths) {
  if (meetings_.empty() || keeps_overlaps(swept, paths)) return;
  cached_reach_ = swept.reach, cached_own_reach_ = swept.own_reach;
  cached_.resize(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) cached_[i] = particles_[i].grown(skin_);
  cached_poses_.clear();
  for (const PoseInterpolation& path : paths) cached_poses_.push_back(path.to());
  if (with_itself_) find_own_overlaps(swept.own_reach);
  int seen_from = FeaturePair::cloth_itself;
  for (Meeting& meeting : meetings_) {
    if (meeting.obstacle == FeaturePair::cloth_itself) continue;
    const std::size_t k = at(meeting.obstacle);
    if (meeting.obstacle != seen_from) {
      seen_from_body(bodies_[k], paths[k], cached_, swept.reach, boxes_[Feature::vertex]);
      seen_from = meeting.obstacle;
    }
    find_mesh_overlaps(meeting);
  }
}

/// Features of the cloth beyond a side of the mesh have none.
void PairSearch::find_mesh_overlaps(Meeting& meeting) {
  const BoxTree& tree = mesh_trees_[at(meeting.obstacle)][meeting.far()];
  const std::vector<Bounds>& vertices = boxes_[Feature::vertex];
  outcodes_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) outcodes_[i] = outcode(vertices[i], tree.bounds());
  const auto collect_of = [&](std::size_t count, const auto& particles_of) {
    collect(count, meeting, [&](std::size_t begin, std::size_t end, std::vector<RegionOverlap>& part) {
      for (std::size_t q = begin; q < end; ++q) {
        unsigned common = ~0U;
        Bounds box;
        for (const int i : particles_of(q)) common &= outcodes_[at(i)], box.add(vertices[at(i)]);
        if (common != 0) continue;
        tree.visit_eights(0, box, [&, query = static_cast<int>(q)](int eight, std::uint32_t hits) {
          part.push_back({query, static_cast<std::uint32_t>(eight), hits});
        });
      }
    });
  };
  if (meeting.near() == Feature::vertex)
    collect_of(vertices.size(), [](std::size_t q) { return std::array{static_cast<int>(q)}; });
  if (meeting.near() == Feature::edge)
    collect_of(
        cloth_.edges.size(), [&](std::size_t q) -> const auto& { return cloth_.edges[q]; });
  if (meeting.near() == Feature::face)
    collect_of(
        cloth_.triangles.size(), [&](std::size_t q) -> const auto& { return cloth_.triangles[q]; });
}

/// Features that share a vertex are no pair.
void PairSearch::find_own_overlaps(double reach) {
  std::vector<Bounds>& vertices = boxes_[Feature::vertex];
  vertices.clear();
  for (const Bounds& box : cached_) vertices.push_back(box.grown(0.5 * reach));
  spread(cloth_, boxes_);
  for (const Feature feature : {Feature::edge, Feature::face}) own_trees_[feature].refit(boxes_[feature]);
  Meeting &edge_meeting = meetings_[0], &face_meeting = meetings_[1];  // as the constructor made them
  const BoxTree &edges = own_trees_[Feature::edge], &faces = own_trees_[Feature::face];
  const auto collect_of = [&](Meeting& meeting, const BoxTree& tree, std::size_t queries,
                              const auto& visit_one) {
    collect(queries, meeting, [&](std::size_t begin, std::size_t end, std::vector<RegionOverlap>& part) {
      for (std::size_t place = begin; place < end; ++place)
        visit_one(place, [&](int query, int first, const Bounds& box, const auto& shares) {
          tree.visit_eights(first, box, [&](int eight, std::uint32_t all) {
            const std::uint32_t hits = without(all, eight, tree.order(), shares);
            if (hits != 0) part.push_back({query, static_cast<std::uint32_t>(eight), hits});
          });
        });
    });
  };
  collect_of(face_meeting, faces, vertices.size(), [&](std::size_t v, const auto& visit) {
    const int vertex = static_cast<int>(v);
    visit(vertex, 0, vertices[v], [&](int face) { return has_vertex(cloth_.triangles[at(face)], vertex); });
  });
  collect_of(edge_meeting, edges, cloth_.edges.size(), [&](std::size_t place, const auto& visit) {
    const int query = edges.order()[place];
    visit(query, static_cast<int>(place) + 1, boxes_[Feature::edge][at(query)],
          [&](int edge) { return share_vertex(cloth_.edges[at(query)], cloth_.edges[at(edge)]); });
  });
}

/// collect_part(begin, end, part) for shares of the queries; the parts follow each other in their order.
template <class Collect>
void PairSearch::collect(std::size_t queries, Meeting& meeting, const Collect& collect_part) {
  const int shares =
      in_shares(team_, queries, least_queries, [&](int share, std::size_t begin, std::size_t end) {
        std::vector<RegionOverlap>& part = share == 0 ? meeting.overlaps : parts_[at(share)].overlaps;
        part.clear();
        collect_part(begin, end, part);
      });
  for (int share = 1; share < shares; ++share)
    meeting.overlaps.insert(meeting.overlaps.end(), parts_[at(share)].overlaps.begin(),
                            parts_[at(share)].overlaps.end());
}

/// Appends those of the overlaps whose regions still overlap.
void PairSearch::take_near(const Meeting& meeting, const Regions& far, std::vector<FeaturePair>& pairs) {
  const std::vector<RegionOverlap>& overlaps = meeting.overlaps;
  const bool is_own = meeting.obstacle == FeaturePair::cloth_itself;
  const BoxTree& tree = (is_own ? own_trees_ : mesh_trees_[at(meeting.obstacle)])[meeting.far()];
  const auto find = active_kernels<RegionKernels>().find;
  const auto take = [&](int share, std::size_t begin, std::size_t end) {
    Part& part = parts_[at(share)];
    part.pairs.clear();
    std::vector<FeaturePair>& taken = share == 0 ? pairs : part.pairs;
    for (std::size_t next = begin; begin < end; begin = next) {
      const int query = overlaps[begin].query;
      while (next < end && overlaps[next].query == query) ++next;
      part.places.resize(std::max(part.places.size(), (next - begin) * EightBoxes::count));
      const int found = find(far.data(), overlaps.data() + begin, static_cast<int>(next - begin),
                             region_of(cloth_, meeting.near(), query, near_), part.places.data());
      for (int k = 0; k < found; ++k)
        taken.push_back({meeting.obstacle, meeting.kind, query, tree.order()[at(part.places[at(k)])]});
    }
  };
  const int shares = in_shares(team_, overlaps.size(), least_share, take);
  for (int share = 1; share < shares; ++share)
    pairs.insert(pairs.end(), parts_[at(share)].pairs.begin(), parts_[at(share)].pairs.end());
}

void PairSearch::find(const SweptBounds& swept, const std::vector<PoseInterpolation>& paths,
                      std::vector<FeaturePair>& pairs) {
  pairs.clear();
  particles_.clear();
  for (const Capsule& capsule : swept.particles) particles_.push_back(box_of(capsule));
  find_overlaps(swept, paths);
  Step step(*this, swept, pairs);
  if (with_itself_) step.find_own();
  for (std::size_t k = 0; k < bodies_.size(); ++k) step.find(static_cast<int>(k), paths[k]);
}

int PairSearch::hierarchy_depth(int body) const {
  if (body != FeaturePair::cloth_itself) return mesh_trees_[at(body)][Feature::face].depth();
  return own_trees_[Feature::face].depth();
}

void PairSearch::append_boxes(int body, int level, const Vec3Field& position, double reach,
                              std::vector<Bounds>& boxes) {
  if (body != FeaturePair::cloth_itself)
    return mesh_trees_[at(body)][Feature::face].append_rounded_boxes(level, boxes);
  if (!with_itself_) return;
  boxes_[Feature::vertex].clear();
  for (std::size_t i = 0; i < position.size(); ++i)
    boxes_[Feature::vertex].push_back(bounds_of(position[i]).grown(reach));
  spread(cloth_, boxes_);
  own_trees_[Feature::face].refit(boxes_[Feature::face]);
  own_trees_[Feature::face].append_rounded_boxes(level, boxes);
}

}  // namespace cloth
