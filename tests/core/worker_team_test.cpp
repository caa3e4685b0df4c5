#include "kernels/worker_team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "kernels/balanced_shares.h"

namespace cloth::worker_team_test {
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

/// Where shares begin follows the times that they took.
TEST(BalancedShares, CoverEveryItemOnceWhateverTheyTook) {
  constexpr std::size_t items = 1000;
  WorkerTeam team(3);
  BalancedShares shares;
  for (int round = 0; round < 100; ++round) {
    std::vector<std::atomic<int>> visits(items);
    std::vector<std::atomic<std::size_t>> ends(3);
    const int count = shares.run(&team, items, 100, [&](int share, std::size_t begin, std::size_t end) {
      if (share == round / 30) std::this_thread::sleep_for(std::chrono::microseconds(100));
      for (std::size_t k = begin; k < end; ++k) ++visits[k];
      ends[static_cast<std::size_t>(share)] = end;
    });
    ASSERT_EQ(count, team.size());
    for (std::size_t k = 0; k < items; ++k) ASSERT_EQ(visits[k], 1) << k << " in round " << round;
    for (std::size_t k = 1; k < ends.size(); ++k) EXPECT_LE(ends[k - 1], ends[k]);
  }
  int alone = 0;
  EXPECT_EQ(shares.run(nullptr, items, 100,
                       [&](int, std::size_t begin, std::size_t end) { alone += begin == 0 && end == items; }),
            1);
  EXPECT_EQ(alone, 1);
}

/// Every share waits now and then, another one each time, so that who comes late changes.
TEST(Milestone, ShowsThoseWhoAwaitItWhatCameBefore) {
  constexpr int numbers = 60;
  WorkerTeam team(4);
  for (int shares = 1; shares <= team.size(); ++shares) {
    const auto count = static_cast<std::size_t>(shares);
    std::vector<std::array<int, numbers + 1>> written(count);  // not atomic: the milestones order them
    std::vector<Milestone> milestones(count);
    for (Milestone& milestone : milestones) milestone.begin();
    std::atomic<int> missed{0};
    team.run(shares, [&](int share) {
      const auto own = static_cast<std::size_t>(share), next = (own + 1) % count;
      for (int k = 1; k <= numbers; ++k) {
        if (k % shares == share) std::this_thread::sleep_for(std::chrono::microseconds(200));
        written[own][static_cast<std::size_t>(k)] = k;
        milestones[own].reach(k);
        milestones[next].await(k);
        if (written[next][static_cast<std::size_t>(k)] != k) ++missed;
      }
    });
    EXPECT_EQ(missed, 0) << shares << " shares";
  }
}

TEST(Milestone, ThatIsPassedIsNotAwaited) {
  Milestone milestone;
  milestone.reach(7);
  const auto start = std::chrono::steady_clock::now();
  milestone.await(3);
  milestone.await(7);
  milestone.begin();
  milestone.await(0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace cloth::worker_team_test
