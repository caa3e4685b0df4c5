// A fit for readers: a terminal, JSON, CSV, plots and a page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "io/file_digest.h"
#include "report/html_page.h"
#include "report/line_plot.h"

namespace cloth {

/// Targets that are points of one measured curve.
struct FitCurve {
  std::string name{};
  Axis x{}, y{};
  std::vector<std::size_t> targets{};  ///< indices, in the order of x
  std::vector<double> at{};            ///< x of each
};

/// What a fit was of. Targets that are in no curve stand alone.
struct FitAccount {
  std::string title{};    ///< of the scene, or of whatever was fitted
  std::string command{};  ///< that makes it; empty: none
  FitProblem problem{};
  FitOptions options{};
  FitResult result{};
  std::vector<FitCurve> curves{};
  double wall = 0;  ///< s
};

inline constexpr const char *fit_index_name = "identified.json", *fit_format = "clothlab/fit/1";

/// Measured points with two sigmas to each side, and the simulated line.
LinePlot curve_plot(const FitAccount& account, const FitCurve& curve);
/// (simulated - measured)/sigma of the targets of a curve, or of all that are in none, against their x or
/// their number.
LinePlot residual_plot(const FitAccount& account, const FitCurve* curve);

std::string fit_text(const FitAccount& account);
std::string fit_json(const FitAccount& account);
/// The same as identified.json, the index of a folder with these files.
std::string fit_index(const FitAccount& account, const std::vector<FileDigest>& files);
/// The fit that a folder's identified.json describes, without its options' numbers, correlations, directions
/// and descents; or the file, the place in it and the rule that it breaks. Exactly one of the two is there.
struct FitReading {
  std::optional<FitAccount> account;
  std::string problem;
};
FitReading read_fit(const std::filesystem::path& folder);

/// parameter,unit,value,low,high,standard_error,verdict
std::string parameters_csv(const FitAccount& account);
/// target,unit,at,measured,sigma,simulated,simulated_error,residual,held_out
std::string targets_csv(const FitAccount& account);
std::string fit_page(const FitAccount& account);

/// Which values hold, in one sentence.
std::string conclusion_of(const FitResult& result, const std::vector<FitParameter>& parameters);

}  // namespace cloth
