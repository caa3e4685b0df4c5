// Comparisons as JSON (.compare.json): reading with every problem at once, writing, and the JSON Schema.
//
//     { "format": "clothlab/comparison/1", "title": "...",
//       "scene": { ... } or the name of a built-in scene,
//       "panes": [ { "name": "A", "title": "...", "own": { "integrator.method": "rk4" } }, ... ],
//       "reference": "controlled" }
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "scene/scene_json.h"

namespace cloth {

inline constexpr const char* comparison_format = "clothlab/comparison/1";

/// A comparison, or why there is none. Exactly one of the two is there.
struct ComparisonReading {
  std::optional<Comparison> comparison;
  std::vector<Problem> problems;
};

/// `place` names the text in messages; its folder is that of meshes, if no other is given. `overrides` set
/// parameters of the shared scene.
ComparisonReading read_comparison(const std::string& text, const std::string& place,
                                  const std::vector<Override>& overrides = {},
                                  const std::optional<SceneFolder>& folder = {});

/// Writes every value, the scene in full, with numbers that read back to the same bits. A comparison for a
/// file goes through moved_to_folder() first.
std::string write_comparison(const Comparison& comparison);

/// JSON Schema (draft 7) of the file.
std::string comparison_schema();

}  // namespace cloth
