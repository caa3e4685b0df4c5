// One point of a sweep: a run of its scene without a folder, reduced to a row.
#pragma once

#include <optional>

#include "study/study_progress.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_rows.h"

namespace cloth {

/// nullopt where `stop` ended it: the point is to be made again. The row has the same bits whatever thread
/// and process make it, but for the wall time. Precondition: the plan of `points` is `plan`.
std::optional<PointRow> run_point(const SweepPlan& plan, const SweepPoints& points, std::int64_t point,
                                  const StopTest& stop);

}  // namespace cloth
