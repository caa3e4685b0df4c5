#include "contact/separations.h"

#include <tuple>
#include <type_traits>

#include "contact/feature_sides.h"
#include "geometry/at.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr double of_closest_points = 1e-6;  ///< by which a gap may be less than the distance

Vec3 point_in(const ClosestBlock& block, std::size_t which, std::size_t k) {
  return {block.point[which][0][k], block.point[which][1][k], block.point[which][2][k]};
}

FeaturePoints points_in(const ClosestBlock& block, std::size_t k) {
  return {point_in(block, 0, k), point_in(block, 1, k), point_in(block, 2, k), point_in(block, 3, k)};
}

Vec3 separation_in(const ClosestBlock& block, std::size_t k) {
  return {block.separation[0][k], block.separation[1][k], block.separation[2][k]};
}

}  // namespace

/// Whether the block is full then.
bool PairBatch::add(std::size_t item, const FeaturePoints& points, Waiting& waiting) {
  const auto k = at(waiting.count++);
  waiting.item[k] = item;
  for (std::size_t which = 0; which < 4; ++which)
    for (std::size_t axis = 0; axis < 3; ++axis)
      waiting.block.point[which][axis][k] = points[which][static_cast<Eigen::Index>(axis)];
  return waiting.count == ClosestBlock::size;
}

template <class Take>
void PairBatch::finish_segments(const Take& take) {
  const ClosestBlock& block = segments_.block;
  active_kernels<ClosestKernels>().of_segments(segments_.block);
  for (std::size_t k = 0; k < at(segments_.count); ++k) {
    const auto points = [&] { return points_in(block, k); };
    const SegmentSegment closest = block.is_sound[k] != 0
                                       ? SegmentSegment{block.weight[0][k], block.weight[1][k],
                                                        separation_in(block, k), block.squared_distance[k]}
                                       : std::apply(closest_of_segments, points());
    take(segments_.item[k], points, closest);
  }
  segments_.count = 0;
}

template <class Take>
void PairBatch::finish_triangles(const Take& take) {
  const ClosestBlock& block = triangles_.block;
  active_kernels<ClosestKernels>().on_triangles(triangles_.block);
  for (std::size_t k = 0; k < at(triangles_.count); ++k) {
    const auto points = [&] { return points_in(block, k); };
    const PointTriangle closest =
        block.is_sound[k] != 0 ? PointTriangle{{block.weight[0][k], block.weight[1][k], block.weight[2][k]},
                                               separation_in(block, k),
                                               block.squared_distance[k]}
                               : std::apply(closest_on_triangle, points());
    take(triangles_.item[k], points, closest);
  }
  triangles_.count = 0;
}

/// take(k, points, closest) for pairs that have closest points by vectors, where points() gives those of
/// their features, and alone(k) for the others: in their order, by runs of pairs of one kind with one
/// obstacle.
template <class Take, class Alone>
void PairBatch::go_through(std::span<const FeaturePair> pairs, const Take& take, const Alone& alone) {
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const FeaturePair& first = pairs[begin];
    while (end < pairs.size() && pairs[end].kind == first.kind && pairs[end].obstacle == first.obstacle)
      ++end;
    const PairShape shape = shape_of(first.kind);
    if (shape == PairShape::point_and_solid) {
      for (std::size_t k = begin; k < end; ++k) alone(k);
      continue;
    }
    with_points(first, setting_, [&](const auto& points_of) {
      for (std::size_t k = begin; k < end; ++k) {
        if (shape == PairShape::segments) {
          if (add(k, points_of(pairs[k]), segments_)) finish_segments(take);
        } else {
          if (add(k, points_of(pairs[k]), triangles_)) finish_triangles(take);
        }
      }
    });
    if (segments_.count > 0) finish_segments(take);
    if (triangles_.count > 0) finish_triangles(take);
  }
}

void PairBatch::find_distances(std::span<const FeaturePair> pairs, double* distances) {
  go_through(
      pairs,
      [&](std::size_t k, const auto&, const auto& closest) {
        distances[k] = distance_of(pairs[k], closest.squared_distance, setting_);
      },
      [&](std::size_t k) { distances[k] = cloth::separate(pairs[k], setting_, 0).distance; });
}

template <class Closest>
PairNeed PairBatch::need_of(const FeaturePair& pair, const Closest& closest, double reach,
                            double most) const {
  const double distance = distance_of(pair, closest.squared_distance, setting_);
  if (distance > reach + most) return PairNeed::apart;
  if (!(distance > 2 * (1 + of_closest_points) * most)) return PairNeed::separation;
  if constexpr (std::is_same_v<Closest, SegmentSegment>)
    return is_in_charge(closest) ? PairNeed::separation : PairNeed::waits;
  else
    return is_in_charge(pair, closest, setting_) ? PairNeed::separation : PairNeed::waits;
}

void PairBatch::separate_each(std::span<const FeaturePair> pairs, const NearDistances& within,
                              const PairMotion& motion, Taker taker, const void* context) {
  static const Separation none;
  go_through(
      pairs,
      [&](std::size_t k, const auto& points, const auto& closest) {
        const PairNeed need = need_of(pairs[k], closest, motion.reach(pairs[k]), motion.most[k]);
        if (need == PairNeed::separation)
          taker(context, k, need, separation_of(pairs[k], points(), closest, setting_, within(pairs[k])));
        else
          taker(context, k, need, none);
      },
      [&](std::size_t k) {
        taker(context, k, PairNeed::separation, cloth::separate(pairs[k], setting_, within(pairs[k])));
      });
}

void PairBatch::separate(std::span<const FeaturePair> pairs, const NearDistances& within,
                         Separation* separations) {
  go_through(
      pairs,
      [&](std::size_t k, const auto& points, const auto& closest) {
        separations[k] = separation_of(pairs[k], points(), closest, setting_, within(pairs[k]));
      },
      [&](std::size_t k) { separations[k] = cloth::separate(pairs[k], setting_, within(pairs[k])); });
}

}  // namespace cloth
