#include "kernels/balanced_shares.h"

namespace cloth {

void BalancedShares::begin(int shares) {
  const auto count = static_cast<std::size_t>(shares);
  if (taken_.size() == count) return;
  taken_.assign(count, {});
  beginning_.clear();
  for (int k = 0; k <= shares; ++k) beginning_.push_back(k / static_cast<double>(shares));
}

/// Each share as if its items cost what they cost on average this time. At most by a fifth: a thread may have
/// been interrupted.
void BalancedShares::balance() {
  constexpr double most_change = 0.2, least_seconds = 1e-9;
  double mean = 0, sum = 0;
  for (const Taken& taken : taken_) mean += taken.seconds / static_cast<double>(taken_.size());
  std::vector<double> parts;
  for (std::size_t k = 0; k < taken_.size(); ++k) {
    const double change = mean / std::max(taken_[k].seconds, least_seconds);
    parts.push_back((beginning_[k + 1] - beginning_[k]) *
                    std::clamp(change, 1 - most_change, 1 + most_change));
    sum += parts.back();
  }
  for (std::size_t k = 0; k + 1 < parts.size(); ++k) beginning_[k + 1] = beginning_[k] + parts[k] / sum;
}

}  // namespace cloth
