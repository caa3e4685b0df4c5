#include "bridge/worker_pace.h"

#include <gtest/gtest.h>

#include <limits>

namespace clothlab::worker_pace_test {
namespace {

using Clock = WorkerPace::Clock;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

TEST(WorkerPace, AStepIsDueWhenTheClockHasReachedItsEnd) {
  WorkerPace pace;
  const Clock::time_point start{};
  pace.set_speed(1, 2.0, start);
  EXPECT_FALSE(pace.is_due(2.010, start + milliseconds(9)));
  EXPECT_TRUE(pace.is_due(2.010, start + milliseconds(10)));
}

TEST(WorkerPace, AtATenthOfTheSpeedAStepIsDueTenTimesLater) {
  WorkerPace pace;
  const Clock::time_point start{};
  pace.set_speed(0.1, 0, start);
  EXPECT_FALSE(pace.is_due(0.001, start + milliseconds(9)));
  EXPECT_EQ(duration_cast<milliseconds>(pace.due_time(0.001) - start).count(), 10);
}

TEST(WorkerPace, AsFastAsItGoesEveryStepIsDue) {
  WorkerPace pace;
  const Clock::time_point start{};
  pace.set_speed(std::numeric_limits<double>::infinity(), 0, start);
  EXPECT_TRUE(pace.is_due(1e9, start));
}

TEST(WorkerPace, ADebtIsDroppedInsteadOfChased) {
  WorkerPace pace;
  const Clock::time_point start{};
  pace.set_speed(1, 0, start);
  const auto late = start + milliseconds(5000);
  EXPECT_TRUE(pace.is_due(0.001, late));  // five seconds behind: time restarts here
  EXPECT_FALSE(pace.is_due(0.020, late + milliseconds(1)));
}

TEST(RateMeter, CountsStepsAndSimulatedSecondsPerSecond) {
  RateMeter meter;
  const Clock::time_point start{};
  meter.restart(0, start);
  for (int n = 1; n <= 100; ++n) meter.count(1, 0.002 * n, start + milliseconds(10 * n));
  EXPECT_NEAR(meter.steps_per_second(), 100, 1e-9);
  EXPECT_NEAR(meter.real_time_factor(), 0.2, 1e-9);
}

}  // namespace
}  // namespace clothlab::worker_pace_test
