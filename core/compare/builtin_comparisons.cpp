#include "compare/builtin_comparisons.h"

#include <algorithm>
#include <cassert>

#include "compare/comparison_json.h"

namespace cloth {

const BuiltinComparison* find_builtin_comparison(const std::string& name) {
  const auto& all = builtin_comparisons();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const BuiltinComparison& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Comparison builtin_comparison(const std::string& name) {
  const BuiltinComparison* found = find_builtin_comparison(name);
  assert(found != nullptr);
  const ComparisonReading reading = read_comparison(found->text, name);
  assert(reading.comparison.has_value());
  return *reading.comparison;
}

}  // namespace cloth
