// The order that measured errors show, after a written rule; "pre-asymptotic" where they show none.
#pragma once

#include <string>
#include <vector>

namespace cloth {

struct OrderPoint {
  double step = 0;   ///< s
  double error = 0;  ///< any unit
};

/// Which points count.
struct OrderRule {
  double floor = 0;  ///< uncertainty of the reference, in the errors' unit: 10 of it must lie below
  double scale = 0;  ///< size of the solution, in the errors' unit: 100 eps of it must lie below
  double excited_frequency = 0;  ///< 1/s of the fastest motion that is there: step * this <= largest_phase
  double largest_phase = 0.3;
  double slack = 0.1;  ///< most by which the pairwise orders of a window may differ; 0.2 from order 4 on
};
OrderRule order_rule(int nominal_order);

struct Slope {
  double value = 0, standard_error = 0;
  int points = 0;  ///< 0: there is no slope
};

/// Least squares of ln(error) against ln(step). The standard error needs three points, else it is 0.
Slope fit_slope(const std::vector<OrderPoint>& points);

struct OrderEstimate {
  std::vector<double> pairwise;  ///< ln(E_i/E_i+1)/ln(h_i/h_i+1), coarse to fine
  bool asymptotic = false;
  int first = 0, count = 0;  ///< the window of points that the order is of; 0 if there is none
  Slope order;               ///< over the window
  Slope overall;             ///< over every point above the floor: says something even of scattered errors
  std::string reason;        ///< why there is no asymptotic window
};

/// Roache's rule as the numerical notes write it: a window of at least four points, all with step * excited
/// frequency <= 0.3 and an error above 10 floors and above 100 eps of the scale, whose pairwise orders are
/// monotone (to a fifth of the slack: converged ones scatter) and differ by no more than the slack. The
/// longest such window is taken, of two the finer. `points` from the longest step to the shortest.
OrderEstimate estimate_order(const std::vector<OrderPoint>& points, const OrderRule& rule);

/// "3.98 ± 0.01" or "pre-asymptotic"
std::string order_text(const OrderEstimate& estimate);

}  // namespace cloth
