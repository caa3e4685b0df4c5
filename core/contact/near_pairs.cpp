#include "contact/near_pairs.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// How far an even turn bulges out of the chord between its ends, for a point `radius` metres from the axis.
double bulge(const Passage& passage, double radius) {
  return radius * (1 - std::cos(0.5 * passage.angle()));
}

/// Holds the whole way of a point of an obstacle.
Bounds swept(const Passage& passage, const Vec3& pivot, const Vec3& point, double reach) {
  return bounds_of(passage.from().at(point), passage.to().at(point))
      .grown(reach + bulge(passage, (point - pivot).norm()));
}

Bounds merged(Bounds a, const Bounds& b) {
  a.add(b);
  return a;
}

/// A box as it is seen from an obstacle.
Bounds seen_from(const Pose& pose, const Bounds& box) {
  const Vec3 middle = pose.back(0.5 * (box.lower + box.upper));
  const Vec3 half = pose.turn.cwiseAbs().transpose() * (0.5 * (box.upper - box.lower));
  return {middle - half, middle + half};
}

/// Boxes of the cloth as a mesh meets them on its way, grown by `reach`.
void seen_from_body(const ObstacleBody& body, const Passage& passage, const std::vector<Bounds>& boxes,
                    double reach, std::vector<Bounds>& seen) {
  const Vec3 pivot = passage.from().at(body.pivot);
  const bool at_home = passage.rests() && passage.from() == Pose{};
  seen.resize(boxes.size());
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const Bounds& box = boxes[f];
    seen[f] = at_home ? box : seen_from(passage.from(), box);
    if (!passage.rests()) seen[f].add(seen_from(passage.to(), box));
    const double radius = (0.5 * (box.lower + box.upper) - pivot).norm() + (box.upper - box.lower).norm();
    seen[f] = seen[f].grown(reach + bulge(passage, radius));
  }
}

bool holds(const Bounds& outer, const Bounds& inner) {
  return (outer.lower.array() <= inner.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

bool has_vertex(const Triangle& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

}  // namespace

/// One search.
class PairSearch::Step {
 public:
  Step(PairSearch& search, const std::vector<Bounds>& particles, double reach,
       std::vector<FeaturePair>& pairs)
      : search_(search), cloth_(search.cloth_), particles_(particles), reach_(reach), pairs_(pairs) {
    for (const Bounds& box : particles_) whole_.add(box);
  }

  void meet(int obstacle, const Passage& passage) {
    obstacle_ = obstacle;
    const ObstacleBody& body = search_.bodies_[at(obstacle)];
    switch (body.shape) {
      case Shape::plane:
        return meet_plane(body, passage);
      case Shape::sphere:
        return meet_sphere(body, passage);
      case Shape::box:
        return meet_box(body, passage);
      case Shape::mesh:
        return meet_mesh(body, passage);
    }
  }

  void meet_itself() {
    obstacle_ = FeaturePair::cloth_itself;
    for (const auto& [a, b] : search_.own_overlaps_) {
      if (!overlap(search_.faces_[at(a)], search_.faces_[at(b)])) continue;
      meet_own_vertices(a, b);
      meet_own_vertices(b, a);
      meet_own_edges(a, b);
    }
  }

 private:
  Bounds box_of_edge(int edge) const {
    const auto& [a, b] = cloth_.edges[at(edge)];
    return merged(particles_[at(a)], particles_[at(b)]);
  }
  Bounds box_of_face(int face) const {
    const auto& [a, b, c] = cloth_.triangles[at(face)];
    return merged(merged(particles_[at(a)], particles_[at(b)]), particles_[at(c)]);
  }
  void add(PairKind kind, int feature, int foreign) { pairs_.push_back({obstacle_, kind, feature, foreign}); }

  void meet_plane(const ObstacleBody& body, const Passage& passage) {
    const Vec3 pivot = passage.from().at(body.pivot);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const Vec3 middle = 0.5 * (particles_[i].lower + particles_[i].upper);
      const Vec3 half = 0.5 * (particles_[i].upper - particles_[i].lower);
      double lowest = infinity;
      for (const Pose* pose : {&passage.from(), &passage.to()}) {
        const Vec3 normal = pose->turn * body.normal;
        lowest = std::min(lowest, normal.dot(middle - pose->at(body.point)) - normal.cwiseAbs().dot(half));
      }
      if (passage.angle() > 0) lowest -= bulge(passage, (middle - pivot).norm() + half.norm());
      if (lowest < reach_) add(PairKind::vertex_plane, static_cast<int>(i), 0);
    }
  }

  void meet_sphere(const ObstacleBody& body, const Passage& passage) {
    const Bounds way = swept(passage, body.pivot, body.center, reach_ + body.radius);
    if (!overlap(whole_, way)) return;
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f)
      if (overlap(box_of_face(f), way)) add(PairKind::face_sphere, f, 0);
  }

  void meet_box(const ObstacleBody& body, const Passage& passage) {
    Bounds way;
    std::array<Bounds, 8> corner;
    for (std::size_t k = 0; k < 8; ++k) {
      corner[k] = swept(passage, body.pivot, body.vertices[k], reach_);
      way.add(corner[k]);
    }
    if (!overlap(whole_, way)) return;
    for (std::size_t i = 0; i < particles_.size(); ++i)
      if (overlap(particles_[i], way)) add(PairKind::vertex_box, static_cast<int>(i), 0);
    for (int e = 0; e < static_cast<int>(cloth_.edges.size()); ++e) {
      const Bounds box = box_of_edge(e);
      if (!overlap(box, way)) continue;
      for (std::size_t k = 0; k < 12; ++k)
        if (overlap(box, merged(corner[at(box_edges[k][0])], corner[at(box_edges[k][1])])))
          add(PairKind::edge_edge, e, static_cast<int>(k));
    }
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f) {
      const Bounds box = box_of_face(f);
      if (!overlap(box, way)) continue;
      for (std::size_t k = 0; k < 8; ++k)
        if (overlap(box, corner[k])) add(PairKind::face_vertex, f, static_cast<int>(k));
    }
  }

  void meet_mesh(const ObstacleBody& body, const Passage& passage) {
    seen_from_body(body, passage, particles_, reach_, search_.seen_);
    for (const BoxPair& both : search_.mesh_overlaps_[at(obstacle_)]) meet_face(both.query, both.index, body);
  }

  /// Each feature is met by the triangle that answers for it, so that no pair comes twice.
  void meet_face(int face, int triangle, const ObstacleBody& body) {
    const std::vector<Bounds>& seen = search_.seen_;
    const Triangle& own = cloth_.triangles[at(face)];
    const Bounds near = merged(merged(seen[at(own[0])], seen[at(own[1])]), seen[at(own[2])]);
    const Surface& mesh = body.surface;
    const Bounds& far = search_.mesh_boxes_[at(obstacle_)][at(triangle)];
    if (!overlap(near, far)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cloth_.answers_for_vertex(face, static_cast<int>(k)) && overlap(seen[at(own[k])], far))
        add(PairKind::vertex_face, own[k], triangle);
      const int vertex = mesh.triangles[at(triangle)][k];
      if (mesh.answers_for_vertex(triangle, static_cast<int>(k)) &&
          overlap(near, bounds_of(body.vertices[at(vertex)])))
        add(PairKind::face_vertex, face, vertex);
    }
    for (int k = 0; k < 3; ++k) {
      if (!cloth_.answers_for_edge(face, k)) continue;
      const int e = cloth_.edges_of[at(face)][at(k)];
      const Bounds box = merged(seen[at(cloth_.edges[at(e)][0])], seen[at(cloth_.edges[at(e)][1])]);
      if (!overlap(box, far)) continue;
      for (int j = 0; j < 3; ++j) {
        if (!mesh.answers_for_edge(triangle, j)) continue;
        const int g = mesh.edges_of[at(triangle)][at(j)];
        const auto& [c, d] = mesh.edges[at(g)];
        if (overlap(box, bounds_of(body.vertices[at(c)], body.vertices[at(d)])))
          add(PairKind::edge_edge, e, g);
      }
    }
  }

  /// The same among the cloth's own.
  void meet_own_vertices(int near, int far) {
    const Triangle &a = cloth_.triangles[at(near)], &b = cloth_.triangles[at(far)];
    for (std::size_t k = 0; k < 3; ++k)
      if (cloth_.answers_for_vertex(near, static_cast<int>(k)) && !has_vertex(b, a[k]) &&
          overlap(particles_[at(a[k])], search_.faces_[at(far)]))
        add(PairKind::vertex_face, a[k], far);
  }

  void meet_own_edges(int near, int far) {
    for (int k = 0; k < 3; ++k) {
      if (!cloth_.answers_for_edge(near, k)) continue;
      const int e = cloth_.edges_of[at(near)][at(k)];
      const Bounds box = box_of_edge(e);
      for (int j = 0; j < 3; ++j) {
        if (!cloth_.answers_for_edge(far, j)) continue;
        const int g = cloth_.edges_of[at(far)][at(j)];
        const auto &p = cloth_.edges[at(e)], &q = cloth_.edges[at(g)];
        const bool share = p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
        if (!share && overlap(box, box_of_edge(g))) add(PairKind::edge_edge, e, g);
      }
    }
  }

  PairSearch& search_;
  const Surface& cloth_;
  const std::vector<Bounds>& particles_;
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
      mesh_boxes_(bodies.size()),
      mesh_trees_(bodies.size()),
      mesh_overlaps_(bodies.size()) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].shape != Shape::mesh) continue;
    needs_trees_ = true;
    const std::vector<Vec3>& vertices = bodies[k].vertices;
    for (const auto& [a, b, c] : bodies[k].surface.triangles)
      mesh_boxes_[k].push_back(bounds_of(vertices[at(a)], vertices[at(b)], vertices[at(c)]));
    mesh_trees_[k] = BoxTree(mesh_boxes_[k]);
  }
  needs_trees_ = needs_trees_ || with_itself_;
}

/// What the trees have found is kept while every particle stays in its grown box and no mesh moves. It may
/// say too much; what is in the boxes of this step is told apart afterwards, so that the pairs do not depend
/// on it.
void PairSearch::look_in_trees(const std::vector<Bounds>& particles, const std::vector<Passage>& passages,
                               double reach) {
  const auto stays = [&](std::size_t i) { return holds(kept_[i], particles[i]); };
  bool kept = kept_.size() == particles.size() && kept_reach_ == reach;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    kept = kept &&
           (bodies_[k].shape != Shape::mesh || (passages[k].rests() && passages[k].to() == kept_poses_[k]));
  for (std::size_t i = 0; kept && i < particles.size(); ++i) kept = stays(i);
  if (kept) return;

  kept_reach_ = reach;
  kept_.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) kept_[i] = particles[i].grown(skin_);
  kept_poses_.clear();
  for (const Passage& passage : passages) kept_poses_.push_back(passage.to());
  find_faces(kept_);
  if (with_itself_) {
    refit_cloth();
    own_overlaps_.clear();
    cloth_tree_.collect_own(own_overlaps_);
  }
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].shape != Shape::mesh) continue;
    seen_from_body(bodies_[k], passages[k], faces_, reach, seen_);
    mesh_overlaps_[k].clear();
    mesh_trees_[k].collect(seen_, mesh_overlaps_[k]);
  }
}

void PairSearch::refit_cloth() {
  if (cloth_tree_.size() == 0)
    cloth_tree_ = BoxTree(faces_);
  else
    cloth_tree_.refit(faces_);
}

void PairSearch::find_faces(const std::vector<Bounds>& particles) {
  faces_.resize(cloth_.triangles.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto& [a, b, c] = cloth_.triangles[f];
    faces_[f] = merged(merged(particles[at(a)], particles[at(b)]), particles[at(c)]);
  }
}

void PairSearch::find(const std::vector<Bounds>& particles, const std::vector<Passage>& passages,
                      double reach, std::vector<FeaturePair>& pairs) {
  pairs.clear();
  if (needs_trees_) {
    look_in_trees(particles, passages, reach);
    find_faces(particles);
  }
  Step step(*this, particles, reach, pairs);
  if (with_itself_) step.meet_itself();
  for (std::size_t k = 0; k < bodies_.size(); ++k) step.meet(static_cast<int>(k), passages[k]);
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
  faces_.resize(cloth_.triangles.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto& [a, b, c] = cloth_.triangles[f];
    faces_[f] = bounds_of(position[at(a)], position[at(b)], position[at(c)]).grown(reach);
  }
  refit_cloth();
  cloth_tree_.append_rounded_boxes(level, boxes);
}

}  // namespace cloth
