#include "contact/near_pairs.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

void inflate(Box& box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
}

/// How far an even turn bulges out of the chord between its ends, for a point `radius` metres from the axis.
double bulge(const Passage& passage, double radius) {
  return radius * (1 - std::cos(0.5 * std::min(passage.angle(), M_PI)));
}

/// Holds the whole way of a point of an obstacle.
Box swept_box(const Passage& passage, const Vec3& pivot, const Vec3& point, double reach) {
  Box box(passage.from().at(point));
  box.extend(passage.to().at(point));
  inflate(box, reach + bulge(passage, (point - pivot).norm()));
  return box;
}

class PairSearch {
 public:
  PairSearch(const Surface& cloth, const std::vector<Box>& particle_boxes, double reach,
             std::vector<FeaturePair>& pairs)
      : cloth_(cloth), boxes_(particle_boxes), reach_(reach), pairs_(pairs) {
    for (const Box& box : boxes_) whole_.extend(box);
  }

  void meet(int obstacle, const ObstacleBody& body, const Passage& passage) {
    obstacle_ = obstacle;
    switch (body.shape) {
      case Shape::plane:
        return meet_plane(body, passage);
      case Shape::sphere:
        return meet_sphere(body, passage);
      case Shape::box:
        return meet_box(body, passage);
    }
  }

 private:
  Box box_of_edge(int edge) const {
    const auto& [a, b] = cloth_.edges[at(edge)];
    return boxes_[at(a)].merged(boxes_[at(b)]);
  }
  Box box_of_face(int face) const {
    const auto& [a, b, c] = cloth_.triangles[at(face)];
    return boxes_[at(a)].merged(boxes_[at(b)]).merged(boxes_[at(c)]);
  }
  void add(PairKind kind, int feature, int foreign) { pairs_.push_back({obstacle_, kind, feature, foreign}); }

  void meet_plane(const ObstacleBody& body, const Passage& passage) {
    const Vec3 pivot = passage.from().at(body.pivot);
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      double lowest = infinity;
      for (const Pose* pose : {&passage.from(), &passage.to()}) {
        const Vec3 normal = pose->turn * body.normal;
        const double level = normal.dot(pose->at(body.point));
        const double middle = normal.dot(boxes_[i].center());
        lowest = std::min(lowest, middle - normal.cwiseAbs().dot(0.5 * boxes_[i].sizes()) - level);
      }
      if (passage.angle() > 0)
        lowest -= bulge(passage, (boxes_[i].center() - pivot).norm() + boxes_[i].sizes().norm());
      if (lowest < reach_) add(PairKind::vertex_plane, static_cast<int>(i), 0);
    }
  }

  void meet_sphere(const ObstacleBody& body, const Passage& passage) {
    const Box swept = swept_box(passage, body.pivot, body.center, reach_ + body.radius);
    if (!whole_.intersects(swept)) return;
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f)
      if (box_of_face(f).intersects(swept)) add(PairKind::face_sphere, f, 0);
  }

  void meet_box(const ObstacleBody& body, const Passage& passage) {
    Box swept;
    std::array<Box, 8> corner;
    std::array<Box, 12> edge;
    for (std::size_t k = 0; k < 8; ++k) {
      corner[k] = swept_box(passage, body.pivot, body.vertices[k], reach_);
      swept.extend(corner[k]);
    }
    if (!whole_.intersects(swept)) return;
    for (std::size_t k = 0; k < 12; ++k)
      edge[k] = corner[at(box_edges[k][0])].merged(corner[at(box_edges[k][1])]);

    for (std::size_t i = 0; i < boxes_.size(); ++i)
      if (boxes_[i].intersects(swept)) add(PairKind::vertex_box, static_cast<int>(i), 0);
    for (int e = 0; e < static_cast<int>(cloth_.edges.size()); ++e) {
      const Box box = box_of_edge(e);
      if (!box.intersects(swept)) continue;
      for (int k = 0; k < 12; ++k)
        if (box.intersects(edge[at(k)])) add(PairKind::edge_edge, e, k);
    }
    for (int f = 0; f < static_cast<int>(cloth_.triangles.size()); ++f) {
      const Box box = box_of_face(f);
      if (!box.intersects(swept)) continue;
      for (int k = 0; k < 8; ++k)
        if (box.intersects(corner[at(k)])) add(PairKind::face_vertex, f, k);
    }
  }

  const Surface& cloth_;
  const std::vector<Box>& boxes_;
  double reach_;
  std::vector<FeaturePair>& pairs_;
  Box whole_;
  int obstacle_ = FeaturePair::cloth_itself;
};

}  // namespace

void find_near_pairs(const Surface& cloth, const std::vector<Box>& particle_boxes,
                     const std::vector<ObstacleBody>& bodies, const std::vector<Passage>& passages,
                     double reach, bool, std::vector<FeaturePair>& pairs) {
  pairs.clear();
  PairSearch search(cloth, particle_boxes, reach, pairs);
  for (std::size_t k = 0; k < bodies.size(); ++k) search.meet(static_cast<int>(k), bodies[k], passages[k]);
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace cloth
