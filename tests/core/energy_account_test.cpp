#include "simulation/energy_account.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulation/run_summary.h"
#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"

namespace cloth::test::energy_account_test {
namespace {

/// `start`: J, the total energy that the ledger began with.
Measurement row(double kinetic, double elastic, double gravity, double start = 0) {
  Measurement m;
  m.ledger.initial = start;
  m.energy.kinetic = kinetic;
  m.energy.elastic = elastic;
  m.energy.gravity = gravity;
  return m;
}

RunSummary swing(const char* method, std::optional<double> time_step, double duration) {
  Scene scene = builtin_scene("pendulum");
  scene.integrator.method = method;
  scene.integrator.time_step = time_step;
  scene.record.interval = 0.05;
  scene.duration = duration;
  return run_scene(scene, {.folder = {}, .progress = {}}).summary;
}

TEST(EnergyAccount, SetsTheLargestErrorAgainstTheLargestEnergyExchanged) {
  EnergyAccount account;
  const double start = 10;
  account.add(row(0, 0, 10, start));
  account.add(row(3, 0, 6, start));    // 4 J fell, 1 J is missing
  account.add(row(2, 1, 7.5, start));  // 0.5 J too much
  EXPECT_DOUBLE_EQ(account.exchanged(), 4);
  EXPECT_DOUBLE_EQ(account.largest_error(), 1);
  EXPECT_DOUBLE_EQ(account.error(), 0.5);
  EXPECT_DOUBLE_EQ(account.share(), 0.25);
}

TEST(EnergyAccount, CountsAWorkAsEnergyExchanged) {
  EnergyAccount account;
  Measurement blown = row(0, 0, 0);
  account.add(blown);
  blown.ledger.forces.air = 5;
  blown.ledger.forces.damping_loss = 5;
  account.add(blown);
  EXPECT_EQ(account.exchanged(), 5);
  EXPECT_EQ(account.share(), 0);
}

/// A rate that is kept only ever takes energy: what a limiter gives, a loss by the method may hide.
TEST(EnergyAccount, CountsWhatALimiterGaveAsAnError) {
  EnergyAccount account;
  Measurement m = row(0, 0, 0);
  account.add(m);
  m.ledger.forces.air = 5;
  m.energy.kinetic = 5;
  m.ledger.limiter = -1;  // taken
  m.energy.kinetic = 4;
  account.add(m);
  EXPECT_EQ(account.largest_error(), 0);
  m.ledger.limiter = 1;  // given, and lost again by the method
  m.energy.kinetic = 5;
  account.add(m);
  EXPECT_EQ(account.error(), -1);
  EXPECT_EQ(account.largest_error(), 1);
  m.energy.kinetic = 6;  // given, and still there
  account.add(m);
  EXPECT_EQ(account.error(), 0);
  EXPECT_EQ(account.largest_error(), 1);
  EXPECT_DOUBLE_EQ(account.share(), 1.0 / 6);
}

TEST(EnergyAccount, TakesRoundingForNoError) {
  EnergyAccount account;
  Measurement still = row(0, 0, 1, 1);
  account.add(still);
  still.energy.gravity += 1e-15;
  account.add(still);
  EXPECT_EQ(account.share(), 0);
  EXPECT_FALSE(account.is_doubtful());
}

TEST(EnergyAccount, IsDoubtfulWhereAnEnergyIsNotANumber) {
  EnergyAccount account;
  account.add(row(0, 0, 1));
  account.add(row(std::numeric_limits<double>::quiet_NaN(), 0, 1));
  account.add(row(0, 0, 1));
  EXPECT_TRUE(account.is_doubtful());
}

TEST(EnergyAccount, OfAMethodThatKeepsTheEnergyCloses) {
  const RunSummary run = swing("verlet", std::nullopt, 1);
  EXPECT_GT(run.energy.exchanged(), 0.1);
  EXPECT_LE(run.energy.share(), 0.02);
  EXPECT_EQ(run.notice, "");
}

TEST(EnergyAccount, OfARunThatLosesATwentiethIsSaidInItsSummary) {
  const RunSummary run = swing("implicit-euler", 0.05, 1);
  EXPECT_EQ(run.status, Status::finished);
  EXPECT_GT(run.energy.share(), EnergyAccount::doubtful_share);
  EXPECT_NE(run.notice.find("energy is not accounted for"), std::string::npos) << run.notice;
  EXPECT_NE(summary_json(run).find("energy_error_share"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::energy_account_test
