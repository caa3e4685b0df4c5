// Where comparisons come from: files, the built-in ones, and a scene that is open.
#pragma once

#include <QString>
#include <optional>

#include "compare/comparison.h"

namespace clothlab {

/// A comparison, or why there is none, in words for a person.
struct OpenedComparison {
  std::optional<cloth::Comparison> comparison;
  QString path;      ///< of the file; empty for a built-in one
  QString problems;  ///< every problem, a line each
};

/// `name` is a file or a built-in comparison, as on the command line.
OpenedComparison open_comparison(const QString& name);

/// Empty when done, else what went wrong.
QString save_comparison_file(const cloth::Comparison& comparison, const QString& path);

/// Whether a file of this name is taken for a comparison rather than for a scene.
bool is_comparison_name(const QString& name);

/// The scene as it is, beside the same with two other methods; these choose their step themselves where the
/// scene's is beyond their limit.
cloth::Comparison comparison_of_scene(const cloth::Scene& scene);

}  // namespace clothlab
