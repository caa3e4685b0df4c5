#include "sparse/line_interpolation.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "geometry/at.h"

namespace cloth {
namespace {

constexpr int reach = CoarseLine::mask_reach;
constexpr double linear_mask[] = {0, 0.5, 1, 0.5, 0}, spline_mask[] = {0.125, 0.5, 0.75, 0.5, 0.125};

using Weights = std::map<int, double>;

/// Parents of a fine point by the mask alone, which may lie beyond the ends.
Weights by_mask(int point, const double* mask) {
  Weights weights;
  for (int parent = point / 2 - 1; parent <= point / 2 + 1; ++parent) {
    const int from_parent = point - 2 * parent;
    const double weight = std::abs(from_parent) <= reach ? mask[from_parent + reach] : 0;
    if (weight != 0) weights[parent] = weight;
  }
  return weights;
}

/// Those beyond an end of the coarse line [0, last] by what lies on it: its end's value, or a straight line.
Weights within_ends(const Weights& of_mask, int last, Interpolation interpolation) {
  Weights weights;
  for (const auto& [parent, weight] : of_mask) {
    const int inside = std::clamp(parent, 0, last);
    weights[inside] += weight;
    if (inside == parent || interpolation == Interpolation::linear) continue;
    weights[inside] += weight;
    weights[parent < 0 ? 1 : last - 1] -= weight;
  }
  std::erase_if(weights, [](const auto& entry) { return entry.second == 0; });
  return weights;
}

LineWeights packed(const Weights& weights) {
  LineWeights result;
  result.first = weights.begin()->first;
  result.count = weights.rbegin()->first - result.first + 1;
  for (const auto& [point, weight] : weights)
    result.weight[point - result.first] = static_cast<float>(weight);
  return result;
}

}  // namespace

LineInterpolation::LineInterpolation(int points, bool halved, Interpolation interpolation)
    : mask_(interpolation == Interpolation::linear ? linear_mask : spline_mask) {
  std::vector<Weights> children(at(halved ? (points + 1) / 2 : points));
  const int last = static_cast<int>(children.size()) - 1;
  for (int point = 0; point < points; ++point) {
    const Weights of_mask = halved ? by_mask(point, mask_) : Weights{{point, 1.0}};
    const Weights parents = within_ends(of_mask, last, interpolation);
    if (parents == of_mask && halved) {
      if (regular_end_ == 0) regular_begin_ = point;
      regular_end_ = point + 1;
    }
    parents_.push_back(packed(parents));
    for (const auto& [parent, weight] : parents) children[at(parent)][point] = weight;
  }
  for (const Weights& weights : children) children_.push_back(packed(weights));
}

CoarseLine LineInterpolation::line() const {
  CoarseLine line{.fine = static_cast<int>(parents_.size()),
                  .coarse = coarse_points(),
                  .parents = parents_.data(),
                  .children = children_.data(),
                  .mask = {},
                  .regular_begin = regular_begin_,
                  .regular_end = regular_end_};
  std::transform(mask_, mask_ + CoarseLine::mask_size, line.mask,
                 [](double weight) { return static_cast<float>(weight); });
  return line;
}

}  // namespace cloth
