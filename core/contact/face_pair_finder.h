// Pairs of features (vertex-face, edge-edge) of two faces that may collide: those that are separated neither
// by their bounding boxes nor along the normals of the two faces.
#pragma once

#include <span>
#include <vector>

#include "contact/feature_pairs.h"
#include "contact/slab.h"
#include "geometry/at.h"
#include "geometry/box_tree.h"
#include "geometry/rounded_box.h"

namespace cloth {

inline bool has_vertex(const Triangle& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

/// Edge k of one triangle and edge j of another.
inline bool edges_share_vertex(const Triangle& one, std::size_t k, const Triangle& other, std::size_t j) {
  const int a = one[k], b = one[(k + 1) % 3], c = other[j], d = other[(j + 1) % 3];
  return a == c || a == d || b == c || b == d;
}

/// Whether two faces can have pairs: as they represent features, see Surface. Many faces that touch
/// each other have none.
inline bool have_pairs(const Surface& near, int face, const Surface& far, int far_face) {
  const unsigned own = near.represented[at(face)], other = far.represented[at(far_face)];
  return ((own | other) & 7U) != 0 || (own >> 3 != 0 && other >> 3 != 0);
}

/// Of the same cloth, whose features may share particles.
inline bool have_own_pairs(const Surface& cloth, int face, int far_face) {
  if (!have_pairs(cloth, face, cloth, far_face)) return false;
  const Triangle &own = cloth.triangles[at(face)], &other = cloth.triangles[at(far_face)];
  for (int k = 0; k < 3; ++k) {
    if (cloth.represents_vertex(face, k) && !has_vertex(other, own[at(k)])) return true;
    if (cloth.represents_vertex(far_face, k) && !has_vertex(own, other[at(k)])) return true;
  }
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) {
      if (!cloth.represents_edge(face, k) || !cloth.represents_edge(far_face, j)) continue;
      if (!edges_share_vertex(own, at(k), other, at(j))) return true;
    }
  return false;
}

/// A surface whose vertices may be anywhere in a region each; slabs and boxes of its triangles and boxes of
/// its edges bound these.
template <class Region>
struct FacesInRegions {
  const Surface& surface;
  std::span<const Region> vertices;
  std::span<const Slab> faces;
  std::span<const RoundedBox> boxes;
  std::span<const Bounds> edges;
};

/// Regions of particles, and the surface of an obstacle's mesh or of the cloth, all in the obstacle's
/// coordinates. Each feature is taken from its representative triangle, so that no pair is found twice.
template <class NearRegion, class FarRegion>
class FacePairFinder {
 public:
  FacePairFinder(int obstacle, const Surface& near, std::span<const NearRegion> near_vertices,
                 const FacesInRegions<FarRegion>& far)
      : obstacle_(obstacle),
        near_(near),
        far_(far.surface),
        near_vertices_(near_vertices),
        far_vertices_(far.vertices),
        far_faces_(far.faces),
        far_boxes_(far.boxes),
        far_edges_(far.edges) {}

  /// Appends the pairs of the faces in each of `overlaps`; fastest where those of one face follow each other.
  void find(std::span<const BoxPair> overlaps, std::vector<FeaturePair>& pairs) {
    for (std::size_t begin = 0, end = 0; begin < overlaps.size(); begin = end) {
      take(overlaps[begin].query);
      while (end < overlaps.size() && overlaps[end].query == face_) ++end;
      for (const int far_face : near_boxes(overlaps.subspan(begin, end - begin))) find(far_face, pairs);
    }
  }

 private:
  bool is_own() const { return obstacle_ == FeaturePair::cloth_itself; }
  const FarRegion& other_vertex(std::size_t k) const { return far_vertices_[at(other_[k])]; }

  /// The far faces whose boxes may overlap that of `face_`. Without branches: most do not.
  std::span<const int> near_boxes(std::span<const BoxPair> overlaps) {
    if (near_boxes_.size() < overlaps.size()) near_boxes_.resize(overlaps.size());
    const RoundedLimits limits(slab_.box);
    std::size_t count = 0;
    for (const BoxPair& overlap : overlaps) {
      near_boxes_[count] = overlap.index;
      count += limits.may_overlap(far_boxes_[at(overlap.index)]) ? 1 : 0;
    }
    return {near_boxes_.data(), count};
  }

  void find(int far_face, std::vector<FeaturePair>& pairs) {
    const Slab& far = far_faces_[at(far_face)];
    far_face_ = far_face, other_ = far_.triangles[at(far_face)];
    for (std::size_t k = 0; k < 3; ++k)
      near_sides_[k] = far.side_of(along(far.normal, near_vertices_[at(own_[k])]));
    if (all_beyond(near_sides_)) return;
    for (std::size_t k = 0; k < 3; ++k) far_sides_[k] = slab_.side_of(along(slab_.normal, other_vertex(k)));
    if (all_beyond(far_sides_)) return;
    find_vertices(far, pairs);
    find_edges(far, pairs);
  }

  void take(int face) {
    face_ = face, own_ = near_.triangles[at(face)];
    slab_ = slab_of(near_vertices_[at(own_[0])], near_vertices_[at(own_[1])], near_vertices_[at(own_[2])]);
    for (std::size_t k = 0; k < 3; ++k) boxes_[k] = box_of(near_vertices_[at(own_[k])]);
    for (std::size_t k = 0; k < 3; ++k) edge_boxes_[k] = bounds_of(boxes_[k], boxes_[(k + 1) % 3]);
  }

  void find_vertices(const Slab& far, std::vector<FeaturePair>& pairs) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (near_sides_[k] == 0 && near_.represents_vertex(face_, static_cast<int>(k)) &&
          !(is_own() && has_vertex(other_, own_[k])) && overlap(boxes_[k], far.box))
        pairs.push_back({obstacle_, PairKind::vertex_face, own_[k], far_face_});
      if (far_sides_[k] != 0 || !far_.represents_vertex(far_face_, static_cast<int>(k))) continue;
      if ((is_own() && has_vertex(own_, other_[k])) || !overlap(slab_.box, box_of(other_vertex(k)))) continue;
      if (is_own())
        pairs.push_back({obstacle_, PairKind::vertex_face, other_[k], face_});
      else
        pairs.push_back({obstacle_, PairKind::face_vertex, face_, other_[k]});
    }
  }

  void find_edges(const Slab& far, std::vector<FeaturePair>& pairs) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (edge_beyond(near_sides_, k) || !near_.represents_edge(face_, static_cast<int>(k))) continue;
      if (!overlap(edge_boxes_[k], far.box)) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        if (edge_beyond(far_sides_, j) || !far_.represents_edge(far_face_, static_cast<int>(j))) continue;
        if (is_own() && edges_share_vertex(own_, k, other_, j)) continue;
        const int far_edge = far_.edges_of[at(far_face_)][j];
        if (overlap(edge_boxes_[k], far_edges_[at(far_edge)]))
          pairs.push_back({obstacle_, PairKind::edge_edge, near_.edges_of[at(face_)][k], far_edge});
      }
    }
  }

  int obstacle_;
  const Surface &near_, &far_;
  std::span<const NearRegion> near_vertices_;
  std::span<const FarRegion> far_vertices_;
  std::span<const Slab> far_faces_;
  std::span<const RoundedBox> far_boxes_;
  std::span<const Bounds> far_edges_;

  int face_ = -1, far_face_ = -1;
  Triangle own_{}, other_{};
  Slab slab_;
  std::array<Bounds, 3> boxes_, edge_boxes_;  ///< of vertices and edges of `face_`
  Sides near_sides_{}, far_sides_{};
  std::vector<int> near_boxes_;  ///< scratch
};

}  // namespace cloth
