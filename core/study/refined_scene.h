// A scene on a finer or coarser grid: the same sheet, cut into other cells.
//
//     if (const auto problem = refinement_problem(scene)) ...  // a mesh; pins that mean another place
//     for (const int cells : default_cells(scene)) run(refined_scene(scene, cells));
#pragma once

#include <optional>
#include <vector>

#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

/// Why no other grid has this scene's cloth; nothing if others have. A pinned region must be one that every
/// grid has: an edge, a corner, a single particle, or a rectangle all of whose particles are pinned.
std::optional<Problem> refinement_problem(const Scene& scene);

/// Cells across must be multiples of it: then the cells down are whole too, in the scene's proportion, and
/// each pinned region begins and ends on grid lines, and probes keep their places. Precondition: no
/// refinement_problem.
int cell_unit(const Scene& scene);

/// Three grids or more, each with twice the cells of the one before.
std::vector<int> default_cells(const Scene& scene);

/// The rule that a list of grids breaks: ascending multiples of the unit, few enough for a grid.
std::optional<std::string> broken_cells_rule(const Scene& scene, const std::vector<int>& cells);

/// The scene with so many cells across. Its pinned regions and probes stay at their places; with the scene's
/// own number of cells it is the scene itself. Precondition: the cells keep the rule.
Scene refined_scene(const Scene& scene, int cells);

/// Why a scene cannot be run on its grid; empty: it can.
std::string refusal_to_run(const Scene& scene);

}  // namespace cloth
