#include "study/identify/fit_folder.h"

#include <string>
#include <utility>

#include "io/file_digest.h"
#include "io/text_file.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

constexpr const char* fit_runs_name = "runs.jsonl";

std::string plot_name(const std::string& column) {
  return "fit-" + column + ".svg";
}

/// The files of a fit with their texts, but for the index.
std::vector<std::pair<std::string, std::string>> files_of(const IdentifyPlan& plan,
                                                          const FitAccount& account) {
  std::vector<std::pair<std::string, std::string>> files{{"parameters.csv", parameters_csv(account)},
                                                         {"targets.csv", targets_csv(account)}};
  if (!account.result.simulated.empty()) {
    std::vector<double> values;
    for (const FittedParameter& parameter : account.result.parameters) values.push_back(parameter.value);
    files.emplace_back("fitted.scene.json", write_scene(scene_with(plan, values)));
    for (const FitCurve& curve : account.curves)
      files.emplace_back(plot_name(curve.name), to_svg(curve_plot(account, curve)));
  }
  files.emplace_back("report.html", fit_page(account));
  return files;
}

}  // namespace

std::optional<IoError> FitFolder::begin(const std::filesystem::path& folder, const IdentifyPlan& plan,
                                        const std::vector<std::filesystem::path>& inputs) {
  FolderUse use{.kind = "identify",
                .files = {fit_index_name, "parameters.csv", "targets.csv", "fitted.scene.json", "report.html",
                          fit_runs_name},
                .inputs = inputs};
  for (const FittedCurve& curve : plan.curves) use.files.push_back(plot_name(curve.column));
  if (auto error = folder_.lock(folder, use)) return error;
  runs_.emplace(model_hash(plan));
  const bool goes_on = runs_->read(folder_ / fit_runs_name);
  if (auto error = goes_on ? folder_.go_on() : folder_.begin_anew()) return error;
  if (auto error = folder_.remove(fit_index_name)) return error;
  if (auto error = folder_.add(fit_runs_name)) return error;
  return runs_->open(folder_ / fit_runs_name);
}

std::optional<IoError> FitFolder::end(const IdentifyPlan& plan, const FitAccount& account) {
  if (auto error = runs_->error()) return error;
  std::string runs;
  if (auto error = read_text_file(folder_ / fit_runs_name, runs)) return error;
  folder_.note(digest_of(fit_runs_name, runs, false));
  for (const auto& [name, text] : files_of(plan, account))
    if (auto error = folder_.write(name, text, name.ends_with(".csv"))) return error;
  return folder_.finish(fit_index_name, fit_index(account, folder_.digests()));
}

}  // namespace cloth
