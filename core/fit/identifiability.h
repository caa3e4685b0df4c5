// What the slopes of the outputs at a fit say: standard errors, correlations, and the combinations of
// parameters that the data cannot see.
#pragma once

#include <Eigen/Core>

#include "fit/fit.h"

namespace cloth {

/// A combination is seen where its standard deviation is below this, in the parameters' coordinates: one more
/// uncertain than by a factor of e, or by the whole range, is not. Nor is one along which the residuals
/// change by less than a millionth of the best seen one's, which is what differences resolve.
inline constexpr double largest_seen_deviation = 1, smallest_seen_ratio = 1e-6;
/// A parameter has a part in a combination with at least this component of the unit vector.
inline constexpr double smallest_part = 0.1;
/// A parameter is known where its standard error is below a quarter of its value (of its range, where the
/// scale is linear), and below an eighth of the range in its coordinate: two to each side leave half of it.
inline constexpr double largest_relative_error = 0.25, largest_part_of_range = 0.125;

struct Information {
  Eigen::MatrixXd covariance;  ///< (J'J)^-1, of the coordinates, times the error scale squared
  std::vector<FitDirection> directions;
};

/// From d residual/d coordinate of the targets that are fitted. Singular values that are too small to be told
/// from 0 are taken as the smallest that could.
Information information_of(const Eigen::MatrixXd& jacobian, double error_scale,
                           const std::vector<FitParameter>& parameters);

/// A combination in words: "springs.structural x 1.1 with springs.shear x 0.909".
std::string words_of_direction(const std::vector<double>& direction,
                               const std::vector<FitParameter>& parameters);

/// Fills in standard errors, correlations, verdicts and their sentences. The rule, whose first case that
/// holds decides:
///   not_fitted  the fit has not converged
///   unseen      it has a part in a combination that is not seen
///   at_bound    the fit ended at a bound of it
///   uncertain   its standard error is too large (above)
///   ambiguous   another descent ended with a chi squared less than 4 above the best, more than four standard
///               errors away
///   identified  otherwise
void judge(const FitProblem& problem, const Information& information, FitResult& result);

/// The 99.9 % quantile of chi squared with so many degrees of freedom (Wilson and Hilferty 1931).
double improbable_chi_squared(int degrees);

}  // namespace cloth
