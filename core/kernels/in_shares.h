// A parallel loop over independent items, divided evenly among the threads of a team.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "kernels/worker_team.h"

namespace cloth {

/// As many as there are threads; fewer where each has not `least` items. Without a team (null) there is one.
inline int number_of_shares(const WorkerTeam* team, std::size_t count, std::size_t least) {
  const std::size_t most = team ? static_cast<std::size_t>(team->size()) : 1;
  return static_cast<int>(std::clamp<std::size_t>(count / std::max<std::size_t>(1, least), 1, most));
}

/// Divides [0, count) into consecutive shares of at least `least` items, one for each thread at most, and
/// calls job(share, begin, end) for each. Without a team (null) there is one share. Returns the number of
/// shares. `job` must not throw.
template <class Job>
int in_shares(WorkerTeam* team, std::size_t count, std::size_t least, const Job& job) {
  const auto shares = static_cast<std::size_t>(number_of_shares(team, count, least));
  const auto share_of = [&](int share) {
    const auto k = static_cast<std::size_t>(share);
    job(share, count * k / shares, count * (k + 1) / shares);
  };
  if (shares == 1)
    share_of(0);
  else
    team->run(static_cast<int>(shares), share_of);
  return static_cast<int>(shares);
}

/// values[k] = value(k) for k in [0, count), in such shares.
template <class T, class Value>
void fill_in_shares(WorkerTeam* team, std::size_t count, std::size_t least, std::vector<T>& values,
                    const Value& value) {
  static_assert(!std::is_same_v<T, bool>, "bits of one byte cannot be set by two threads");
  values.resize(count);
  in_shares(team, count, least, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) values[k] = value(k);
  });
}

}  // namespace cloth
