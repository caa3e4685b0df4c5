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

/// What a round's motion can take from the distance of each pair, and up to which distance a pair matters, in
/// m.
struct PairMotion {
  std::span<const double> most;
  NearDistances reach;
};

/// Pairs that cannot come within their reach are `apart`; of the others those `wait` that cannot be `nearest`
/// and are further apart than twice what the motion can take.
enum class PairNeed : std::uint8_t { separation, waits, apart };

/// Of one thread. The arguments must outlive it.
class PairBatch {
 public:
  explicit PairBatch(const PairSetting& setting) : setting_(setting) {}

  /// m, one for each pair.
  void find_distances(std::span<const FeaturePair> pairs, double* distances);

  /// One for each pair. Those nearer than `within` are asked whether they are nearest, see separate().
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within, Separation* separations);

  /// Calls take(k, need, separation) for each pair in turn, with the separation of those that need it: most
  /// are not kept, and together they are more than a processor has at hand.
  template <class Take>
  void separate(std::span<const FeaturePair> pairs, const NearDistances& within, const PairMotion& motion,
                const Take& take) {
    separate_each(
        pairs, within, motion,
        [](const void* context, std::size_t k, PairNeed need, const Separation& separation) {
          (*static_cast<const Take*>(context))(k, need, separation);
        },
        &take);
  }

 private:
  struct Waiting {
    ClosestBlock block{};
    std::array<std::size_t, ClosestBlock::size> item{};
    int count = 0;
  };

  using Taker = void (*)(const void* context, std::size_t k, PairNeed need, const Separation& separation);
  void separate_each(std::span<const FeaturePair> pairs, const NearDistances& within,
                     const PairMotion& motion, Taker taker, const void* context);
  template <class Closest>
  PairNeed need_of(const FeaturePair& pair, const Closest& closest, double reach, double most) const;
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
