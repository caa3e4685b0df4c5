#include "contact/distance_bounds.h"

#include <algorithm>
#include <array>
#include <utility>

#include "contact/separations.h"
#include "geometry/at.h"
#include "geometry/bounds.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

RoundedPoint rounded(const Vec3& point, const Vec3& origin) {
  const Vec3 from = point - origin;
  return {{static_cast<float>(from.x()), static_cast<float>(from.y()), static_cast<float>(from.z()), 0}};
}

Vec3 middle_of(const Vec3Field& position) {
  Bounds box;
  for (std::size_t i = 0; i < position.size(); ++i) box.add(bounds_of(position[i]));
  return 0.5 * (box.lower + box.upper);
}

/// Whether both sides have vertices.
bool has_vertices(PairKind kind) {
  return kind == PairKind::edge_edge || kind == PairKind::vertex_face || kind == PairKind::face_vertex;
}

PairVertices vertices_of(const FeaturePair& pair, const Surface& cloth, const Surface& far) {
  if (pair.kind == PairKind::edge_edge) {
    const auto& [a, b] = cloth.edges[at(pair.feature)];
    const auto& [c, d] = far.edges[at(pair.far_feature)];
    return {{a, b, c, d}};
  }
  const bool is_far_face = pair.kind == PairKind::vertex_face;
  const auto& [a, b, c] =
      is_far_face ? far.triangles[at(pair.far_feature)] : cloth.triangles[at(pair.feature)];
  return {{is_far_face ? pair.feature : pair.far_feature, a, b, c}};
}

}  // namespace

void DistanceBounds::begin(const PairSetting& setting, std::span<const FeaturePair> pairs) {
  const Vec3 origin = middle_of(setting.position);
  cloth_.clear();
  for (std::size_t i = 0; i < setting.position.size(); ++i)
    cloth_.push_back(rounded(setting.position[i], origin));
  bodies_.resize(setting.bodies.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    bodies_[k].clear();
    const auto first =
        std::lower_bound(pairs.begin(), pairs.end(), static_cast<int>(k),
                         [](const FeaturePair& pair, int obstacle) { return pair.obstacle < obstacle; });
    if (first == pairs.end() || first->obstacle != static_cast<int>(k)) continue;
    const Vec3* const placed = setting.placed_vertices(first->obstacle);
    const std::vector<Vec3>& vertices = setting.bodies[k].vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      bodies_[k].push_back(rounded(placed ? placed[i] : setting.poses[k].at(vertices[i]), origin));
  }
}

void DistanceBounds::find(const PairSetting& setting, std::span<const FeaturePair> pairs,
                          double* bounds) const {
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const FeaturePair& first = pairs[begin];
    while (end < pairs.size() && pairs[end].kind == first.kind && pairs[end].obstacle == first.obstacle)
      ++end;
    if (has_vertices(first.kind))
      find_run(setting, pairs.subspan(begin, end - begin), bounds + begin);
    else
      PairBatch(setting).find_distances(pairs.subspan(begin, end - begin), bounds + begin);
  }
}

/// Of pairs of one kind with one obstacle.
void DistanceBounds::find_run(const PairSetting& setting, std::span<const FeaturePair> pairs,
                              double* bounds) const {
  constexpr std::size_t block = 256;
  const FeaturePair& first = pairs.front();
  const bool is_own = first.obstacle == FeaturePair::cloth_itself;
  const Surface& far = is_own ? setting.cloth : setting.bodies[at(first.obstacle)].surface;
  const RoundedPoint *near_points = cloth_.data(),
                     *far_points = is_own ? near_points : bodies_[at(first.obstacle)].data();
  if (first.kind == PairKind::face_vertex) std::swap(near_points, far_points);
  const BoundKernels& kernels = active_kernels<BoundKernels>();
  const auto find_bounds = first.kind == PairKind::edge_edge ? kernels.of_segments : kernels.of_triangles;
  std::array<PairVertices, block> vertices;
  std::array<float, block> found;
  for (std::size_t begin = 0; begin < pairs.size(); begin += block) {
    const std::size_t count = std::min(block, pairs.size() - begin);
    for (std::size_t k = 0; k < count; ++k) vertices[k] = vertices_of(pairs[begin + k], setting.cloth, far);
    find_bounds(near_points, far_points, vertices.data(), static_cast<int>(count), found.data());
    for (std::size_t k = 0; k < count; ++k) bounds[begin + k] = static_cast<double>(found[k]);
  }
}

}  // namespace cloth
