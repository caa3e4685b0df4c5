// Separations and distances of many pairs, by vectors: to the bit those that separate() and distance_of()
// give for one pair.
#pragma once

#include <span>

#include "contact/closest_kernels.h"
#include "contact/feature_pairs.h"

namespace cloth {

/// m, by what a pair of the cloth is with.
struct NearDistances {
  double of_obstacles = 0, of_itself = 0;

  double operator()(const FeaturePair& pair) const {
    return pair.obstacle == FeaturePair::cloth_itself ? of_itself : of_obstacles;
  }
};

/// Distances between these two need no separation where a pair cannot be `nearest`.
struct NeedlessDistances {
  std::span<const double> least;  ///< m, of each pair
  NearDistances most;
};

/// Of one thread. The arguments must outlive it.
class PairBatch {
 public:
  explicit PairBatch(const PairSetting& setting) : setting_(setting) {}

  /// m, one for each pair.
  void find_distances(std::span<const FeaturePair> pairs, double* distances);

  /// One for each pair. Those nearer than `within` are asked whether they are nearest, see separate().
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within, Separation* separations);

  /// The same but for needless ones. left_out[k]: whether a pair has no separation therefore.
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within,
                const NeedlessDistances& needless, Separation* separations, std::uint8_t* left_out);

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
