#include "sweep/merge_sweep.h"

#include "io/text_file.h"
#include "sweep/sweep_account.h"
#include "sweep/sweep_report.h"

namespace cloth {

std::optional<IoError> write_merged(const SweepFolder& folder, const SweepResults& results) {
  if (auto error =
          write_text_file(folder.path / "sweep.csv", csv_text(sweep_table(folder.plan, results), "\n")))
    return error;
  const std::vector<SweepPlot> plots = sweep_plots(folder, results);
  for (const SweepPlot& plot : plots)
    if (auto error = write_text_file(folder.path / plot.name, plot.svg)) return error;
  if (has_points(folder.plan))
    for (const PointsFile& file : points_files(points_account(folder, results)))
      if (auto error = write_text_file(folder.path / file.name, file.text)) return error;
  return write_text_file(folder.path / "report.html", sweep_page(folder, results, plots));
}

}  // namespace cloth
