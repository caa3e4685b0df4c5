#include "kernels/shared_job.h"

#include <gtest/gtest.h>

#include <chrono>

namespace cloth::test::shared_job_test {
namespace {

using Spent = WorkerTeam::Spent;

constexpr int two = 2, four = 4;
constexpr double alone = 0.8e-3;                                 // s, a job on one thread
constexpr Spent shared{0.4e-3, 0.05e-3}, held_up{0.4e-3, 3e-3};  // s, with the cores free, and not

struct Jobs {
  int shared = 0, alone = 0;
};

/// Jobs from `now` on, one after the other for `duration` s.
Jobs run(ShareWatch& watch, double& now, double duration, const Spent& spent, int size = two) {
  Jobs jobs;
  for (const double end = now + duration; now < end;) {
    if (!watch.shares(now)) {
      ++jobs.alone, now += alone;
      continue;
    }
    ++jobs.shared, now += spent.working + spent.waiting;
    watch.took(now, size, spent);
  }
  return jobs;
}

TEST(ShareWatch, SharesWhileTheOthersSpareMoreThanTheyAreWaitedFor) {
  ShareWatch watch;
  double now = 5;
  EXPECT_EQ(run(watch, now, 10, shared).alone, 0);
}

TEST(ShareWatch, KeepsToOneThreadForAWhileWhereTheCallerWaits) {
  ShareWatch watch;
  double now = 5;
  run(watch, now, ShareWatch::watched, held_up);
  EXPECT_EQ(run(watch, now, 0.9 * ShareWatch::first_rest, held_up).shared, 0);
}

TEST(ShareWatch, TriesAgainAndThenLessAndLessOften) {
  ShareWatch watch;
  double now = 5;
  const Jobs early = run(watch, now, 2, held_up), late = run(watch, now, 20, held_up);
  EXPECT_GT(early.shared, 0);
  EXPECT_LT(early.shared, early.alone / 50);
  EXPECT_GT(late.shared, 0);
  EXPECT_LT(late.shared, late.alone / 200);
}

TEST(ShareWatch, SharesAgainSoonAfterTheCoresAreFree) {
  ShareWatch watch;
  double now = 5;
  run(watch, now, 30, held_up);
  run(watch, now, ShareWatch::longest_rest, shared);
  EXPECT_EQ(run(watch, now, 10, shared).alone, 0);
}

TEST(ShareWatch, IsNotMisledByASingleInterruption) {
  ShareWatch watch;
  double now = 5;
  constexpr Spent interrupted{0.4e-3, 8e-3};
  run(watch, now, 0.005, shared);
  run(watch, now, 1e-6, interrupted);
  EXPECT_EQ(run(watch, now, 1, shared).alone, 0);
}

TEST(ShareWatch, WaitsLongerForMoreThreads) {
  constexpr Spent spent{0.4e-3, 0.8e-3};
  ShareWatch of_two, of_four;
  double now = 5, other = 5;
  EXPECT_GT(run(of_two, now, 1, spent, two).alone, 0);
  EXPECT_EQ(run(of_four, other, 1, spent, four).alone, 0);
}

TEST(WorkerTeam, TellsWhatItsCallerWorkedAndWaited) {
  WorkerTeam team(2);
  const auto spend = [](double seconds) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < until) continue;
  };
  team.run(2, [&](int share) { spend(share == 0 ? 0.005 : 0.03); });
  EXPECT_GE(team.spent().working, 0.005);
  const Spent before = team.spent();
  team.run(1, [&](int) { spend(0.005); });
  EXPECT_EQ(team.spent().working, before.working);
  EXPECT_EQ(team.spent().waiting, before.waiting);
  EXPECT_GE(before.working + before.waiting, 0.025);
}

TEST(SharedJob, HasItsTeamAlwaysWhereThatIsAskedForAndNoneWithout) {
  SharedJob job;
  EXPECT_EQ(job.begin(), nullptr);
  job.end();
  WorkerTeam team(2);
  job.set_team(&team, ThreadUse::always);
  EXPECT_EQ(job.begin(), &team);
  job.end();
  job.set_team(&team, ThreadUse::where_they_gain);
  EXPECT_EQ(job.begin(), &team);  // until it has been seen to wait
  job.end();
}

}  // namespace
}  // namespace cloth::test::shared_job_test
