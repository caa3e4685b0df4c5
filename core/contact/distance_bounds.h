// Lower bounds of the distances of many pairs of features (bound_kernels.h), for choosing among them.
#pragma once

#include <span>
#include <vector>

#include "contact/bound_kernels.h"
#include "contact/feature_pairs.h"

namespace cloth {

class DistanceBounds {
 public:
  /// Rounds the vertices of these pairs, which are those of PairSearch, in their order. Keeps its memory.
  void begin(const PairSetting& setting, std::span<const FeaturePair> pairs);
  /// m, one for each of these, which are some of the pairs that begin() had in this setting; may be negative
  /// or -infinity. Of planes, boxes as solids and balls the distance itself. Threads may call it at once.
  void find(const PairSetting& setting, std::span<const FeaturePair> pairs, double* bounds) const;

 private:
  void find_run(const PairSetting& setting, std::span<const FeaturePair> pairs, double* bounds) const;

  std::vector<RoundedPoint> cloth_;
  std::vector<std::vector<RoundedPoint>> bodies_;  ///< the vertices of those with pairs
};

}  // namespace cloth
