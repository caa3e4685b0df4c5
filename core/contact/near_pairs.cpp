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
    find_faces();
    BoxTree& tree = search_.cloth_tree_;
    if (tree.size() == 0)
      tree = BoxTree(search_.faces_);
    else
      tree.refit(search_.faces_);
    search_.overlaps_.clear();
    tree.collect(search_.faces_, search_.overlaps_);
    for (const BoxPair& both : search_.overlaps_)
      if (both.query != both.index) meet_own_face(both.query, both.index);
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
  void find_faces() {
    search_.faces_.resize(cloth_.triangles.size());
    for (std::size_t f = 0; f < search_.faces_.size(); ++f)
      search_.faces_[f] = box_of_face(static_cast<int>(f));
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
    const BoxTree& tree = search_.mesh_trees_[at(obstacle_)];
    const Vec3 pivot = passage.from().at(body.pivot);
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f) {
      const Bounds box = box_of_face(f);
      Bounds seen = seen_from(passage.from(), box);
      if (!passage.rests()) seen.add(seen_from(passage.to(), box));
      const double radius = (0.5 * (box.lower + box.upper) - pivot).norm() + (box.upper - box.lower).norm();
      tree.visit(seen.grown(reach_ + bulge(passage, radius)),
                 [&](int triangle) { meet_face(f, triangle, body.surface); });
    }
  }

  /// Each feature is met by the triangle that answers for it, so that no pair comes twice.
  void meet_face(int face, int triangle, const Surface& mesh) {
    for (int k = 0; k < 3; ++k) {
      if (cloth_.answers_for_vertex(face, k))
        add(PairKind::vertex_face, cloth_.triangles[at(face)][at(k)], triangle);
      if (mesh.answers_for_vertex(triangle, k))
        add(PairKind::face_vertex, face, mesh.triangles[at(triangle)][at(k)]);
      if (!cloth_.answers_for_edge(face, k)) continue;
      for (int j = 0; j < 3; ++j)
        if (mesh.answers_for_edge(triangle, j))
          add(PairKind::edge_edge, cloth_.edges_of[at(face)][at(k)], mesh.edges_of[at(triangle)][at(j)]);
    }
  }

  /// The same among the cloth's own.
  void meet_own_face(int near, int far) {
    const Triangle &a = cloth_.triangles[at(near)], &b = cloth_.triangles[at(far)];
    for (std::size_t k = 0; k < 3; ++k)
      if (cloth_.answers_for_vertex(near, static_cast<int>(k)) && !has_vertex(b, a[k]) &&
          overlap(particles_[at(a[k])], search_.faces_[at(far)]))
        add(PairKind::vertex_face, a[k], far);
    if (near > far) return;
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

PairSearch::PairSearch(const Surface& cloth, const std::vector<ObstacleBody>& bodies, bool with_itself)
    : cloth_(cloth), bodies_(bodies), with_itself_(with_itself), mesh_trees_(bodies.size()) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].shape != Shape::mesh) continue;
    std::vector<Bounds> boxes;
    for (const auto& [a, b, c] : bodies[k].surface.triangles)
      boxes.push_back(
          bounds_of(bodies[k].vertices[at(a)], bodies[k].vertices[at(b)], bodies[k].vertices[at(c)]));
    mesh_trees_[k] = BoxTree(boxes);
  }
}

void PairSearch::find(const std::vector<Bounds>& particles, const std::vector<Passage>& passages,
                      double reach, std::vector<FeaturePair>& pairs) {
  pairs.clear();
  Step step(*this, particles, reach, pairs);
  if (with_itself_) step.meet_itself();
  for (std::size_t k = 0; k < bodies_.size(); ++k) step.meet(static_cast<int>(k), passages[k]);
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace cloth
