// The strips of the validation as tasks for any simulator: what each is made like, where it starts, and how
// far somebody's result is from the exact curve.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/file_digest.h"
#include "io/text_file.h"
#include "study/validation/validation.h"

namespace cloth {

/// Cells along the strips that are handed out.
inline constexpr int bench_cells = 20;

/// The rows that have a curve.
std::vector<ValidationRow> strip_tasks();

/// strips.csv: a line for each task. Material in SI units, ends, exact value, and which vertices of the
/// starting mesh are held.
std::string strips_csv(const std::vector<ValidationRow>& tasks);

/// strips.json, the index of their folder.
std::string strips_index(const std::vector<FileDigest>& files);

/// The starting mesh of a task, on the exact curve; m, gravity along -y, cross-section after cross-section
/// from the first end to the last.
std::string starting_obj(const ValidationRow& task);

/// What somebody's points say, in the strip's length.
struct StripScore {
  std::string name{};
  std::size_t points = 0;         ///< beside the strip, those behind clamps left out
  double rms = 0, largest = 0;    ///< distances from the points to the nearest point of the curve
  std::optional<double> value{};  ///< none: the task has no value, or its points do not reach far enough
  double exact = 0;
  std::string failure{};  ///< why there is no score
};

/// `points` in the strip's length, in any order.
StripScore score_strip(const ValidationRow& task, const std::vector<Eigen::Vector2d>& points);

/// Every file NAME.csv (columns x, y, m) and NAME.obj of the folder that has the name of a task. An error
/// where the folder or a file cannot be read; a file that holds something else is a score with a failure.
std::optional<IoError> score_folder(const std::filesystem::path& folder, std::vector<StripScore>& scores);

std::string score_text(const std::vector<StripScore>& scores);
std::string score_json(const std::vector<StripScore>& scores);

}  // namespace cloth
