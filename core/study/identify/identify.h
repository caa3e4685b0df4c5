// Parameters of a scene from measured values: what is asked for, the runs, and the fit (fit/fit.h).
//
//     IdentifyPlan plan{.scene = scene};
//     plan.varied.push_back(std::get<VariedParameter>(parse_vary("springs.structural:10:1000", scene)));
//     plan.targets.push_back(std::get<ColumnTarget>(parse_target("max_strain:max=0.05±0.001", scene,
//     "--target"))); const FitAccount account = identify(plan);
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "analysis/fit_report.h"
#include "params/problem.h"
#include "scene/scene.h"
#include "study/identify/fit_runs.h"
#include "study/run_output.h"
#include "study/study_progress.h"

namespace cloth {

struct VariedParameter {
  std::string path{}, unit{};
  double low = 0, high = 0;  ///< bounds
  double start = 0;          ///< the scene's value, within them
  bool is_whole = false;     ///< a whole number: outputs jump
};

/// A reduction of a column that was measured.
struct ColumnTarget {
  std::string column{};
  Reduction over = Reduction::final_value;  ///< max, min, mean, or the value at the end
  double measured = 0;
  std::optional<double> sigma{};
  bool held_out = false;
  /// As parse_output takes it.
  std::string name() const { return over == Reduction::final_value ? column : column + ":" + name_of(over); }
};

/// A column that was measured over time.
struct FittedCurve {
  std::string column{};
  std::vector<double> times{}, values{};  ///< s, and the column's unit
  std::vector<double> sigmas{};           ///< empty: not known
};

struct IdentifyPlan {
  Scene scene;
  std::vector<VariedParameter> varied{};
  std::vector<ColumnTarget> targets{};
  std::vector<FittedCurve> curves{};
  FitOptions options{};
  int jobs = 1;             ///< runs beside each other; no bit depends on it
  StopTest stop{};          ///< asked between batches of steps
  std::string command{};    ///< that makes it, for its page
  FitRuns* runs = nullptr;  ///< of model_hash(plan), where they are kept
};

/// "PATH" or "PATH:LOW:HIGH" (with units where wanted). Without a range: from a tenth of the scene's value to
/// ten times it, within what the parameter may be. The coordinate is the logarithm where the range is above
/// 0.
std::variant<VariedParameter, Problem> parse_vary(const std::string& text, const Scene& scene);

/// "SOURCE=VALUE", "SOURCE:max=VALUE" (":min", ":mean") or either with "±SIGMA" ("+-" too): a column of
/// record.csv or a shape measure (study/run_output.h), at the end or over the rows.
std::variant<ColumnTarget, Problem> parse_target(const std::string& text, const Scene& scene,
                                                 const std::string& option);

/// The columns of a CSV file with a column time_s and others with the names of columns of the record;
/// NAME_sigma holds the standard deviations of NAME.
std::variant<std::vector<FittedCurve>, std::vector<Problem>> read_curves(const std::string& file,
                                                                         const Scene& scene);

/// What keeps the plan from being carried out.
std::vector<Problem> find_problems(const IdentifyPlan& plan);

/// Of all that the outputs of a run depend on beside the values of the varied parameters: not of bounds,
/// measured values, and how it is searched.
std::string model_hash(const IdentifyPlan& plan);

/// Precondition: find_problems is empty. A run that cannot be written (`runs`) stops the fit.
FitAccount identify(const IdentifyPlan& plan);

/// The scene with these values of the varied parameters.
Scene scene_with(const IdentifyPlan& plan, const std::vector<double>& values);

}  // namespace cloth
