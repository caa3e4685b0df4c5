// The runs of a sweep as plots of points and sensitivity take them (analysis/points_report.h).
#pragma once

#include "analysis/points_report.h"
#include "sweep/sweep_results.h"

namespace cloth {

/// Whether a sweep is shown by parallel coordinates, main effects and a scatter matrix: it varies more than
/// two parameters, or takes a sample or a table of points.
bool has_points(const SweepPlan& plan);

/// The rows that are there, of more than `most` evenly some: a column for each axis (of a table of points for
/// each of its columns) and for each output. Words and vectors are numbered as the axis lists them, which the
/// column's label says. Tags are the points.
PointTable points_table(const SweepFolder& folder, const SweepResults& results,
                        std::size_t most = std::numeric_limits<std::size_t>::max() / 2);

/// That table with what the design tells. One for sensitivity has a row for each point, without values where
/// it failed or is not there yet, so that effects can be told from the order of its points.
PointsAccount points_account(const SweepFolder& folder, const SweepResults& results);

}  // namespace cloth
