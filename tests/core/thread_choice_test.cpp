#include "kernels/thread_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cloth::test::thread_choice_test {
namespace {

struct Costs {
  double alone, together;  ///< s, of a job with one thread and with all
};

/// Runs `jobs` jobs of these costs; returns how many of them all threads did.
int run(ThreadChoice& choice, int jobs, const Costs& costs, int most = 4) {
  int shared = 0;
  for (int k = 0; k < jobs; ++k) {
    const int threads = choice.next(most);
    EXPECT_TRUE(threads == 1 || threads == most);
    shared += threads > 1;
    choice.took(choice.wants_time() ? (threads > 1 ? costs.together : costs.alone) : 0);
  }
  return shared;
}

constexpr Costs gain{10e-6, 6e-6}, loss{10e-6, 12e-6}, stalled{10e-6, 4e-3};

TEST(ThreadChoice, SharesAJobThatSeveralThreadsDoSooner) {
  ThreadChoice choice;
  run(choice, ThreadChoice::trial, gain);
  EXPECT_EQ(run(choice, ThreadChoice::first_hold, gain), ThreadChoice::first_hold);
}

TEST(ThreadChoice, KeepsToOneThreadWhereSeveralTakeLonger) {
  ThreadChoice choice;
  run(choice, ThreadChoice::trial, loss);
  EXPECT_EQ(run(choice, ThreadChoice::first_hold, loss), 0);
}

TEST(ThreadChoice, TriesBothAgainLater) {
  ThreadChoice choice;
  run(choice, ThreadChoice::trial + ThreadChoice::first_hold, loss);
  run(choice, ThreadChoice::trial, gain);
  EXPECT_EQ(run(choice, ThreadChoice::first_hold, gain), ThreadChoice::first_hold);
}

TEST(ThreadChoice, TriesLessAndLessOften) {
  constexpr int jobs = 100 * ThreadChoice::longest_hold;
  ThreadChoice choice;
  const int shared = run(choice, jobs, loss);
  EXPECT_GT(shared, 0);
  EXPECT_LT(shared, jobs / 50);
}

TEST(ThreadChoice, LeavesThreadsThatOthersKeepWaiting) {
  ThreadChoice choice;
  run(choice, ThreadChoice::trial, gain);
  EXPECT_LE(run(choice, ThreadChoice::first_hold, stalled), 40);
}

TEST(ThreadChoice, KeepsThreadsThatWereInterruptedOnce) {
  constexpr Costs large{100e-6, 60e-6}, interrupted{100e-6, 4e-3};
  ThreadChoice choice;
  run(choice, ThreadChoice::trial, large);
  EXPECT_EQ(run(choice, 1, interrupted), 1);
  EXPECT_EQ(run(choice, ThreadChoice::first_hold - 1, large), ThreadChoice::first_hold - 1);
}

TEST(ThreadChoice, IsNotMisledByAFewInterruptedJobs) {
  ThreadChoice choice;
  for (int k = 0; k < ThreadChoice::trial; ++k) {
    const Costs costs = k % 7 == 3 ? Costs{5e-3, 5e-3} : gain;
    run(choice, 1, costs);
  }
  EXPECT_EQ(run(choice, ThreadChoice::first_hold, gain), ThreadChoice::first_hold);
}

TEST(ThreadChoice, TriesAboutAsManyJobsAloneAsTogether) {
  ThreadChoice choice;
  EXPECT_EQ(run(choice, ThreadChoice::trial, gain), ThreadChoice::trial / 2);
}

/// Jobs of which as many as may be are done as one; returns how many were done by all threads.
int run_at_once(ThreadChoice& choice, int jobs, const Costs& costs) {
  int shared = 0;
  for (int done = 0; done < jobs;) {
    const int threads = choice.next(4), part = std::min(choice.at_once(), std::min(32, jobs - done));
    shared += threads > 1 ? part : 0;
    choice.took(choice.wants_time() ? part * (threads > 1 ? costs.together : costs.alone) : 0, part);
    done += part;
  }
  return shared;
}

TEST(ThreadChoice, TellsJobsApartWhileItTriesAndNotAfterwards) {
  for (const Costs& costs : {gain, loss}) {
    ThreadChoice choice;
    choice.next(4);
    EXPECT_EQ(choice.at_once(), 1);
    EXPECT_EQ(run_at_once(choice, ThreadChoice::trial, costs), ThreadChoice::trial / 2);
    choice.next(4);
    EXPECT_GT(choice.at_once(), 1000);
    const bool gains = costs.together < costs.alone;
    EXPECT_EQ(run_at_once(choice, ThreadChoice::first_hold, costs), gains ? ThreadChoice::first_hold : 0);
  }
}

TEST(ThreadChoice, LeavesThreadsThatOthersKeepWaitingAmongJobsDoneAsOne) {
  ThreadChoice choice;
  run_at_once(choice, ThreadChoice::trial, gain);
  EXPECT_LE(run_at_once(choice, ThreadChoice::first_hold, stalled), 40);
}

TEST(ThreadChoice, HasNothingToChooseWithOneThread) {
  ThreadChoice choice;
  EXPECT_EQ(run(choice, 100, gain, 1), 0);
  EXPECT_FALSE(choice.wants_time());
}

TEST(ThreadChoice, BeginsAnewWithAnotherNumberOfThreads) {
  ThreadChoice choice;
  run(choice, ThreadChoice::trial, gain, 4);
  EXPECT_EQ(run(choice, ThreadChoice::trial, loss, 2), ThreadChoice::trial / 2);
  EXPECT_EQ(run(choice, ThreadChoice::first_hold, loss, 2), 0);
}

}  // namespace
}  // namespace cloth::test::thread_choice_test
