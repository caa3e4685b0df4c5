// What is required of every cell of the table of extreme cases, whatever methods there are.
#include "study/extremes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "study/extremes_report.h"
#include "support/scenes.h"

namespace cloth::test::extremes_test {
namespace {

/// A case with fewer steps, so that slow methods are tested too.
ExtremeCase shortened(ExtremeCase extreme, std::int64_t max_steps) {
  extreme.max_steps = std::min(extreme.max_steps, max_steps);
  extreme.max_evaluations = 5000;
  return extreme;
}

ExtremeCase case_named(const std::string& name) {
  for (const ExtremeCase& extreme : extreme_cases())
    if (extreme.name == name) return extreme;
  ADD_FAILURE() << "no case " << name;
  return {};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

template <class Visit>  // visit(extreme, method)
void for_each_cell(std::int64_t max_steps, Visit visit) {
  // One step of error control takes seconds at these; their neighbours are as telling.
  const std::set<std::string> slow{"stiffness-1e7", "stiffness-1e8", "stiffness-1e9-own-step"};
  for (const ExtremeCase& extreme : extreme_cases())
    if (!slow.count(extreme.name))
      for (const std::string& method : integrator_names()) visit(shortened(extreme, max_steps), method);
}

TEST(ExtremeCases, HaveNamesOfTheirOwnAndScenesWithoutProblems) {
  std::set<std::string> names;
  for (const ExtremeCase& extreme : extreme_cases()) {
    EXPECT_TRUE(names.insert(extreme.name).second) << extreme.name;
    EXPECT_FALSE(extreme.what.empty() || extreme.reading.empty()) << extreme.name;
    for (const Problem& problem : find_problems(extreme.scene))
      ADD_FAILURE() << extreme.name << problem.text();
  }
  for (const char* name : {"stiffness-1e0", "stiffness-1e9", "mass-ratio-1e5", "step-1e-6", "step-1s",
                           "scrambled", "unreachable-pins", "all-pinned", "1e6-m-away"})
    EXPECT_TRUE(names.count(name)) << name;
}

TEST(EveryCell, IsAFiniteResultOrAStopThatNamesStepParticleAndCause) {
  for_each_cell(20, [](const ExtremeCase& extreme, const std::string& method) {
    const ExtremeCell cell = run_extreme(extreme, method);
    const std::string where = extreme.name + ", " + method + ": " + cell.detail;
    EXPECT_TRUE(std::isfinite(cell.max_strain) && std::isfinite(cell.energy_ratio)) << where;
    EXPECT_GE(cell.energy_ratio, 0) << where;
    EXPECT_LE(cell.steps, extreme.max_steps) << where;
    EXPECT_FALSE(contains(cell.detail, "nan")) << where;
    EXPECT_LT(static_cast<std::size_t>(cell.status), std::size(extreme_status_names)) << where;
    if (cell.status == ExtremeStatus::diverged || cell.status == ExtremeStatus::solver_failed)
      EXPECT_TRUE(contains(cell.detail, " in step ") && contains(cell.detail, " at particle ")) << where;
    else if (cell.status == ExtremeStatus::refused)
      EXPECT_TRUE(cell.steps == 0 && contains(cell.detail, "no stable time step")) << where;
    else
      EXPECT_GT(cell.steps, 0) << where;
  });
}

TEST(EveryStatus, IsAWordOfTheFiles) {
  using enum ExtremeStatus;
  std::vector<std::string> words;
  for (const auto status :
       {stable, not_converged, energy_growth, diverged, unreachable, refused, solver_failed})
    words.emplace_back(name_of(status));
  EXPECT_EQ(words, (std::vector<std::string>{"stable", "not-converged", "energy-growth", "diverged",
                                             "unreachable", "refused", "solver-failed"}));
}

TEST(ACell, IsTheSameAgain) {
  for (const char* name : {"scrambled", "compressed-5-percent", "coincident-particles", "unreachable-pins"}) {
    for (const std::string& method : integrator_names()) {
      const ExtremeCase extreme = shortened(case_named(name), 10);
      ExtremeCell first = run_extreme(extreme, method), second = run_extreme(extreme, method);
      first.wall = second.wall = 0;
      EXPECT_EQ(written(first).texts, written(second).texts);
    }
  }
}

TEST(MethodsThatDampWhatIsTooFast, AreStableAtEveryStiffnessAtASixtiethOfASecond) {
  for (int decade = 0; decade <= 9; ++decade) {
    const ExtremeCase extreme = case_named("stiffness-1e" + std::to_string(decade));
    EXPECT_EQ(extreme.scene.integrator.time_step, 1.0 / 60);
    for (const char* method : {"implicit-euler", "bdf2"}) {
      const ExtremeCell cell = run_extreme(extreme, method);
      EXPECT_EQ(cell.status, ExtremeStatus::stable) << extreme.name << ", " << method << ": " << cell.detail;
    }
  }
}

TEST(TheMidpointRule, DivergesOnAStiffClothThatSwings) {
  EXPECT_EQ(run_extreme(case_named("stiffness-1e2"), "implicit-midpoint").status, ExtremeStatus::stable);
  for (const char* name : {"stiffness-1e6", "stiffness-1e9"}) {
    const ExtremeCell cell = run_extreme(case_named(name), "implicit-midpoint");
    EXPECT_EQ(cell.status, ExtremeStatus::diverged) << cell.detail;
  }
}

TEST(LocalMethods, GainEnergyOrStopOnAStiffClothThatSwings) {
  for (const char* method : {"projective", "xpbd", "vbd"}) {
    EXPECT_EQ(run_extreme(case_named("stiffness-1e3"), method).status, ExtremeStatus::stable) << method;
    const ExtremeStatus stiff = run_extreme(case_named("stiffness-1e8"), method).status;
    EXPECT_TRUE(stiff == ExtremeStatus::energy_growth || stiff == ExtremeStatus::diverged) << name_of(stiff);
  }
}

TEST(AStepWhoseIterationsEndTooSoon, IsSaidNotToBeConverged) {
  const ExtremeCell cell = run_extreme(case_named("step-1s"), "projective");
  EXPECT_EQ(cell.status, ExtremeStatus::not_converged) << cell.detail;
  EXPECT_TRUE(contains(cell.detail, "residual up to")) << cell.detail;
}

TEST(AtItsOwnStep, AMethodIsStableAtEveryStiffness) {
  for (const int decade : {0, 3, 6, 9})
    for (const std::string method : {"semi-implicit-euler", "verlet", "rk4"}) {
      const ExtremeCell cell =
          run_extreme(case_named("stiffness-1e" + std::to_string(decade) + "-own-step"), method);
      EXPECT_EQ(cell.status, ExtremeStatus::stable) << decade << ", " << method << ": " << cell.detail;
    }
}

TEST(BeyondItsLimit, AnExplicitMethodDiverges) {
  for (const char* name : {"stiffness-1e4", "step-1s"})
    for (const char* method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"})
      EXPECT_EQ(run_extreme(case_named(name), method).status, ExtremeStatus::diverged) << name << method;
}

TEST(ExplicitEuler, IsRefusedAStepOfItsOwnWithoutDamping) {
  EXPECT_EQ(run_extreme(case_named("no-damping-own-step"), "explicit-euler").status, ExtremeStatus::refused);
}

TEST(UnreachablePins, AreSaidToBeSoWhateverTheMethodMakesOfThem) {
  for (const std::string& method : integrator_names()) {
    const ExtremeCell cell = run_extreme(shortened(case_named("unreachable-pins"), 20), method);
    EXPECT_NE(cell.status, ExtremeStatus::stable) << method;
    EXPECT_TRUE(contains(cell.detail, "deformation.rate cannot be kept")) << method << ": " << cell.detail;
    if (cell.status == ExtremeStatus::unreachable) {
      EXPECT_TRUE(contains(cell.detail, "excess over the rate")) << cell.detail;
    }
  }
  EXPECT_EQ(run_extreme(case_named("unreachable-pins"), "verlet").status, ExtremeStatus::unreachable);
}

TEST(AParticleThatIsFasterThanTheBoxIsThick, IsWarnedOf) {
  const ExtremeCell cell = run_extreme(shortened(case_named("particle-at-1-km/s"), 5), "verlet");
  EXPECT_TRUE(contains(cell.detail, "particle 40 moves 2 m in a step")) << cell.detail;
}

TEST(PinnedParticles, AllOfThemStayWhateverTheMethod) {
  for (const std::string& method : integrator_names()) {
    const ExtremeCell cell = run_extreme(shortened(case_named("all-pinned"), 20), method);
    EXPECT_NEAR(cell.energy_ratio, 0, 1e-24) << method;
    EXPECT_NEAR(cell.max_strain, 0, 1e-12) << method;
  }
}

TEST(EnergyGrowth, IsSeenInARunThatStaysFinite) {
  ExtremeCase growing = case_named("no-damping");  // explicit Euler grows from the first step on
  growing.max_steps = 110;
  const ExtremeCell cell = run_extreme(growing, "explicit-euler");
  EXPECT_EQ(cell.status, ExtremeStatus::energy_growth) << cell.detail;
  EXPECT_TRUE(contains(cell.detail, "of the energy scale was added")) << cell.detail;
}

TEST(EnergyGrowth, OfACollapsedClothIsMadeByTheStep) {
  ExtremeCase collapsed = case_named("collapsed-to-a-point");
  EXPECT_EQ(run_extreme(collapsed, "verlet").status, ExtremeStatus::energy_growth);
  collapsed.scene.integrator.time_step = 2e-5;  // a hundredth
  collapsed.max_steps *= 100;
  EXPECT_EQ(run_extreme(collapsed, "verlet").status, ExtremeStatus::stable);
}

TEST(ARunThatIsStopped, EndsAtTheNextStep) {
  EXPECT_EQ(run_extreme(case_named("step-1e-4"), "verlet", [] { return true; }).steps, 1);
}

}  // namespace
}  // namespace cloth::test::extremes_test
