// What a merge leaves in a sweep's folder: sweep.csv, plots and report.html.
#pragma once

#include "sweep/sweep_results.h"

namespace cloth {

/// Of the points that are there. Precondition: no disagreements.
std::optional<IoError> write_merged(const SweepFolder& folder, const SweepResults& results);

}  // namespace cloth
