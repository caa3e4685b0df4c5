// The reader of comparisons.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "compare/comparison_json.h"
#include "fuzz/small_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (!cloth::test::stays_small(text)) return -1;
  const cloth::ComparisonReading reading = cloth::read_comparison(text, "x.compare.json");
  if (reading.comparison.has_value() != reading.problems.empty()) std::abort();
  for (const cloth::Problem& problem : reading.problems)
    if (problem.rule.empty()) std::abort();
  if (!reading.comparison) return 0;
  const std::string written = cloth::write_comparison(*reading.comparison);
  if (!cloth::read_comparison(written, "x.compare.json").comparison) std::abort();
  return 0;
}
