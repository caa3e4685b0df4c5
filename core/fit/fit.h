// Parameters from measured values: what makes a model's outputs come closest to them, how sure that is, and
// what the values cannot tell.
//
//     FitProblem problem{.parameters = {{"material.bending_warp", "N m", 1e-6, 1e-3}},
//                        .targets = {{.name = "droop", .measured = 0.081, .sigma = 0.001}},
//                        .evaluate = run_all};
//     const FitResult found = fit(problem, {});
//     found.parameters[0].value          // with .low and .high, and .verdict
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cloth {

/// In which coordinate a parameter is fitted: its logarithm, or its part of the way from low to high.
enum class FitScale { logarithmic, linear };

struct FitParameter {
  std::string name{}, unit{};
  double low = 0, high = 1;  ///< bounds; low < high, and 0 < low where logarithmic
  FitScale scale = FitScale::logarithmic;
};

struct FitTarget {
  std::string name{}, unit{};
  double measured = 0;
  double sigma = 1;       ///< standard deviation of the measured value, > 0
  bool held_out = false;  ///< not fitted, but predicted from the fit
};

/// The model's outputs, one for each target, at each of the points (one number for each parameter). Runs of
/// one call do not need each other. Not a number where a run gave none.
using FitModel =
    std::function<std::vector<std::vector<double>>(const std::vector<std::vector<double>>& points)>;

struct FitProblem {
  std::vector<FitParameter> parameters{};
  std::vector<FitTarget> targets{};
  FitModel evaluate{};
  /// Whether the sigmas are those of the measurement. Otherwise they only weigh the targets, and the
  /// residuals say how large they are.
  bool sigmas_known = true;
};

enum class FitMethod { levenberg_marquardt, derivative_free };
inline constexpr const char* fit_method_names[] = {"levenberg-marquardt", "derivative-free"};
inline const char* name_of(FitMethod method) {
  return fit_method_names[static_cast<std::size_t>(method)];
}

struct FitProgress {
  std::size_t evaluations = 0;
  double chi_squared = 0;        ///< the lowest so far; infinity before there is one
  std::vector<double> values{};  ///< there
};

struct FitOptions {
  FitMethod method = FitMethod::levenberg_marquardt;
  std::vector<double> start{};      ///< empty: the middle of the range, in the parameters' coordinates
  std::size_t starts = 10;          ///< points of a Latin hypercube that are looked at beside the start
  std::size_t descents = 3;         ///< from the start and the best of these points; at least 1
  std::size_t max_iterations = 50;  ///< of a descent: of a step each; derivative free: 20 evaluations each
  double difference_step = 0;  ///< of central differences, in the coordinates; 0: 0.001, derivative free 0.05
  std::uint64_t seed = 1;
  std::function<bool(const FitProgress&)> progress{};  ///< after each batch of runs; false stops the fit
};

enum class FitStatus {
  converged,
  stalled,  ///< no step lowers chi squared, though the slopes say so: the outputs jump, or are rough
  max_iterations,
  no_start,  ///< the model has no value at any of the starts
  stopped
};
inline constexpr const char* fit_status_names[] = {"converged", "stalled", "max-iterations", "no-start",
                                                   "stopped"};
inline const char* name_of(FitStatus status) {
  return fit_status_names[static_cast<std::size_t>(status)];
}

/// What the data say of a parameter; the rule is that of judge() in identifiability.h.
enum class FitVerdict { identified, uncertain, unseen, ambiguous, at_bound, not_fitted };
inline constexpr const char* fit_verdict_names[] = {"identified", "uncertain", "unseen",
                                                    "ambiguous",  "at-bound",  "not-fitted"};
inline const char* name_of(FitVerdict verdict) {
  return fit_verdict_names[static_cast<std::size_t>(verdict)];
}

struct FittedParameter {
  double value = 0;
  double low = 0, high = 0;   ///< two standard errors to each side, in the coordinate
  double standard_error = 0;  ///< in the parameter's unit; infinity: unseen
  double relative_error = 0;  ///< in the coordinate: of the logarithm, or as a part of the range
  FitVerdict verdict = FitVerdict::not_fitted;
  std::string why{};  ///< a sentence; empty: identified
};

/// A combination of parameters, a unit vector in their coordinates, and how the outputs see it.
struct FitDirection {
  double singular_value = 0;  ///< change of the residuals, in sigmas, along it
  std::vector<double> direction{};
  bool seen = true;
  std::string words{};  ///< "a x 1.1 with b x 0.909"
};

struct FitDescent {
  FitStatus status = FitStatus::converged;
  std::vector<double> start{}, end{};  ///< values of the parameters
  double chi_squared = 0;              ///< at the end
  std::size_t evaluations = 0;
};

struct FitResult {
  FitStatus status = FitStatus::no_start;
  std::vector<FittedParameter> parameters{};
  double chi_squared = 0;
  int degrees = 0;                        ///< of freedom: fitted targets less parameters
  double error_scale = 1;                 ///< that standard errors were multiplied by, see `cautions`
  std::vector<double> simulated{};        ///< of every target, at the fit
  std::vector<double> simulated_error{};  ///< what the parameters' uncertainty makes of it
  std::vector<std::vector<double>> correlation{};
  std::vector<FitDirection> directions{};   ///< the best seen first
  std::vector<FitDescent> descents{};       ///< the best first
  std::size_t evaluations = 0, failed = 0;  ///< runs, and those without a value
  std::vector<std::string> cautions{};      ///< a sentence each

  bool all_identified() const;
};

/// What is wrong with the problem, a sentence each; fit() asks that there be nothing.
std::vector<std::string> broken_fit_rules(const FitProblem& problem, const FitOptions& options);

FitResult fit(const FitProblem& problem, const FitOptions& options);

}  // namespace cloth
