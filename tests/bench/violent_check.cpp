// Random violent scenes at "auto": none may diverge. Prints its seed, every scene that did, and how each kind
// went.
//
//     clothlab-violent-check [SCENES [SEED [FIRST]]]      2000 scenes of seed 1 from number 0; exit code 1 if
//     one diverged
#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "support/violent_scenes.h"

namespace {

struct Tally {
  int scenes = 0, diverged = 0, pinched = 0, shortened = 0, over_tenth = 0, over_one = 0;
  double largest = 0, step = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int place, unsigned long long otherwise) {
    return argc > place ? std::strtoull(argv[place], nullptr, 10) : otherwise;
  };
  const auto scenes = number(1, 2000), seed = number(2, 1), first = number(3, 0);
  fmt::print("seed {}, scenes {} to {}\n", seed, first, first + scenes - 1);
  std::map<std::string, Tally> tallies;
  int diverged = 0;
  for (auto n = first; n < first + scenes; ++n) {
    const cloth::test::ViolentScene scene = cloth::test::violent_scene(seed, n);
    const cloth::test::ViolentRun run = run_violent(scene, scene.steps);
    Tally& tally = tallies[scene.scene.integrator.method + ", " + scene.family];
    ++tally.scenes;
    tally.step += run.mean_step;
    tally.shortened += run.shortened > 0;
    tally.over_tenth += run.largest_error > 0.1;
    tally.over_one += run.largest_error > 1;
    tally.largest = std::max(tally.largest, run.largest_error);
    if (!run.divergence) continue;
    if (run.divergence->pinched) {  // an obstacle met what pins hold
      ++tally.pinched;
      continue;
    }
    ++tally.diverged, ++diverged;
    fmt::print("scene {} ({}, {}) {}\n", n, scene.scene.integrator.method, scene.family,
               describe(*run.divergence));
    std::fflush(stdout);
  }
  fmt::print("\n{:<42} {:>7} {:>9} {:>8} {:>10} {:>10} {:>8} {:>10} {:>10}\n", "method, family", "scenes",
             "diverged", "pinched", "shortened", "error>0.1", "error>1", "largest", "mean step");
  for (const auto& [name, t] : tallies)
    fmt::print("{:<42} {:>7} {:>9} {:>8} {:>10} {:>10} {:>8} {:>10.3g} {:>10.3f}\n", name, t.scenes,
               t.diverged, t.pinched, t.shortened, t.over_tenth, t.over_one, t.largest, t.step / t.scenes);
  fmt::print("{} of {} diverged\n", diverged, scenes);
  return diverged > 0 ? 1 : 0;
}
