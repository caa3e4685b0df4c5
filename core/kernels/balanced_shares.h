// A parallel loop that is repeated, over items whose costs differ: shares that took longer than others become
// shorter the next time.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include "kernels/in_shares.h"

namespace cloth {

class BalancedShares {
 public:
  /// As in_shares(), but that a share can come to have fewer than `least` items. Precondition: what comes of
  /// all shares together does not depend on where one ends.
  template <class Job>
  int run(WorkerTeam* team, std::size_t count, std::size_t least, const Job& job) {
    const int shares = number_of_shares(team, count, least);
    if (!team || shares == 1) {
      job(0, std::size_t{0}, count);
      return 1;
    }
    begin(shares);
    team->run(shares, [&](int share) {
      const auto k = static_cast<std::size_t>(share);
      const auto begun = std::chrono::steady_clock::now();
      job(share, beginning_of(k, count), beginning_of(k + 1, count));
      taken_[k].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    });
    balance();
    return shares;
  }

 private:
  struct alignas(64) Taken {
    double seconds = 0;
  };
  void begin(int shares);
  void balance();
  std::size_t beginning_of(std::size_t share, std::size_t count) const {
    return static_cast<std::size_t>(beginning_[share] * static_cast<double>(count));
  }

  std::vector<double> beginning_;  ///< of each share, as a part of all items; and 1
  std::vector<Taken> taken_;
};

}  // namespace cloth
