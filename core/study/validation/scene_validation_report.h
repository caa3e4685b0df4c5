// Scenes against measured points as tables, as pictures and as one page.
#pragma once

#include <string>
#include <vector>

#include "io/file_digest.h"
#include "report/line_plot.h"
#include "study/validation/scene_validation.h"

namespace cloth {

/// A line for each grid of each scene.
std::string scenes_text(const std::vector<SceneValidation>& scenes);
std::string scenes_csv(const std::vector<SceneValidation>& scenes);
/// `files`: of the folder in which it is the index.
std::string scenes_json(const std::vector<SceneValidation>& scenes,
                        const std::vector<FileDigest>& files = {});

/// What the grids give, as lines, and the measured points; for a single value over the cells.
LinePlot measured_plot(const SceneValidation& study);

/// report.html. `command` is what made it in `wall` s.
std::string scenes_page(const std::vector<SceneValidation>& scenes, const std::string& command, double wall);

}  // namespace cloth
