// The reader of sweeps' plans.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "fuzz/small_scene.h"
#include "sweep/sweep_points.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // A plan names files: none outside of the folder of this test.
  if (!cloth::test::stays_small(text) || text.find("rows") != text.npos || text.find('/') != text.npos)
    return -1;
  const cloth::SweepReading reading = cloth::read_sweep(text, "x.sweep.json");
  if (reading.plan.has_value() != reading.problems.empty()) std::abort();
  for (const cloth::Problem& problem : reading.problems)
    if (problem.rule.empty()) std::abort();
  if (!reading.plan) return 0;
  const std::string written = cloth::write_sweep(*reading.plan);
  const cloth::SweepReading again = cloth::read_sweep(written, "x.sweep.json");
  if (!again.plan || cloth::plan_hash(*again.plan) != cloth::plan_hash(*reading.plan)) std::abort();
  const cloth::SweepPoints points(*reading.plan);
  for (const std::int64_t point : {std::int64_t{0}, points.count() / 2, points.count() - 1})
    points.scene(point);
  return 0;
}
