#include "kernels/worker_team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

namespace cloth {
namespace {

TEST(WorkerTeam, GivesEveryShareToOneThread) {
  WorkerTeam team(4);
  for (int shares = 0; shares <= team.size(); ++shares) {
    std::vector<std::atomic<int>> runs(4);
    team.run(shares, [&](int share) { ++runs[static_cast<std::size_t>(share)]; });
    for (int share = 0; share < 4; ++share)
      EXPECT_EQ(runs[static_cast<std::size_t>(share)], share < shares ? 1 : 0) << shares << " shares";
  }
}

/// Every share waits now and then, another one each time, so that who comes late changes.
TEST(WorkerTeam, AfterAMeetingEachShareSeesWhatTheOthersWroteBefore) {
  constexpr int meetings = 60;
  WorkerTeam team(4);
  for (int shares = 1; shares <= team.size(); ++shares) {
    std::vector<int> written(static_cast<std::size_t>(shares), 0);  // not atomic: the meeting orders them
    std::atomic<int> missed{0};
    team.run(shares, [&](int share) {
      for (int k = 1; k <= meetings; ++k) {
        if (k % shares == share) std::this_thread::sleep_for(std::chrono::microseconds(200));
        written[static_cast<std::size_t>(share)] = k;
        team.meet();
        if (std::accumulate(written.begin(), written.end(), 0) != k * shares) ++missed;
        team.meet();  // nobody writes the next before all have read
      }
    });
    EXPECT_EQ(missed, 0) << shares << " shares";
  }
}

}  // namespace
}  // namespace cloth
