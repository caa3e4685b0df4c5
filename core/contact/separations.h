// Separations and distances of many pairs, by vectors: to the bit those that separate() and distance_of()
// give for one pair.
#pragma once

#include <span>

#include "contact/closest_kernels.h"
#include "contact/feature_pairs.h"

namespace cloth {

/// m: pairs nearer than this are asked whether they are nearest, see separate().
struct NearDistances {
  double of_obstacles = 0, of_itself = 0;

  double operator()(const FeaturePair& pair) const {
    return pair.obstacle == FeaturePair::cloth_itself ? of_itself : of_obstacles;
  }
};

/// Of one thread. The arguments must outlive it.
class PairBatch {
 public:
  explicit PairBatch(const PairSetting& setting) : setting_(setting) {}

  /// m, one for each pair.
  void find_distances(std::span<const FeaturePair> pairs, double* distances);

  /// One for each pair.
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within, Separation* separations);

  /// The same, but for pairs that are further apart than `clear` (m, one for each) and cannot be `nearest`:
  /// these get no separation. left_out[k]: m, the distance of such a pair, of others -1.
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within, const double* clear,
                Separation* separations, double* left_out);

 private:
  struct Waiting {
    ClosestBlock block{};
    std::array<std::size_t, ClosestBlock::size> item{};
    int count = 0;
  };

  template <class Take, class Alone>
  void go_through(std::span<const FeaturePair> pairs, const Take& take, const Alone& alone);
  static bool add(std::size_t item, const FeaturePoints& points, Waiting& waiting);
  template <class Take>
  void finish_segments(const Take& take);
  template <class Take>
  void finish_triangles(const Take& take);

  const PairSetting& setting_;
  Waiting segments_, triangles_;
};

}  // namespace cloth
