// The folder of a fit, which the command line and the window write alike: parameters.csv, targets.csv,
// fitted.scene.json, fit-COLUMN.svg of each measured curve, report.html, and identified.json after them. Its
// runs are in runs.jsonl as soon as they are made, so that a fit that was stopped goes on.
//
//     FitFolder folder;
//     if (auto error = folder.begin("fit", plan, {"measured.csv"})) ...
//     plan.runs = folder.runs();
//     const FitAccount account = identify(plan);
//     if (auto error = folder.end(plan, account)) ...
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/result_folder.h"
#include "study/identify/identify.h"

namespace cloth {

class FitFolder {
 public:
  /// Takes the folder, and the runs of an earlier fit of the same model that it holds. Refuses where another
  /// process writes, where an input or a file that is no fit's would be replaced, and where the folder holds
  /// results of another kind.
  std::optional<IoError> begin(const std::filesystem::path& folder, const IdentifyPlan& plan,
                               const std::vector<std::filesystem::path>& inputs);

  bool is_open() const { return folder_.is_open(); }
  /// Null where no folder was taken.
  FitRuns* runs() { return runs_ ? &*runs_ : nullptr; }

  /// Writes all that the fit gave; an error in keeping its runs comes first.
  std::optional<IoError> end(const IdentifyPlan& plan, const FitAccount& account);

 private:
  ResultFolder folder_;
  std::optional<FitRuns> runs_;
};

}  // namespace cloth
