// The comparisons of resources/comparisons, compiled in.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace cloth {

struct BuiltinComparison {
  std::string name;
  std::string title;  ///< That of the text, known without building the comparison's meshes.
  std::string text;  ///< JSON
};

const std::vector<BuiltinComparison>& builtin_comparisons();

/// nullptr if there is none of that name.
const BuiltinComparison* find_builtin_comparison(const std::string& name);

/// A built-in comparison that must exist, parsed.
Comparison builtin_comparison(const std::string& name);

}  // namespace cloth
