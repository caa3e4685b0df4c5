#include "sweep/merge_sweep.h"

#include "io/text_file.h"

namespace cloth {

std::optional<IoError> write_merged(const SweepFolder& folder, const SweepResults& results) {
  return write_text_file(folder.path / "sweep.csv", csv_text(sweep_table(folder.plan, results), "\n"));
}

}  // namespace cloth
