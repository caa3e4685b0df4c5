// The planar inextensible elastica under its own weight: integrated along its arc, and shot at conditions of
// its other end by Newton's method. What is held against exact curves is built from these.
//
// With the tangent t at an angle from straight down and the force n by which the part beyond a point acts on
// the part before it, equilibrium (Antman 2005, chapter 4) is, lengths in L, forces in B/L^2 per width:
//
//     x' = sin(angle), y' = -cos(angle), angle' = curvature,
//     curvature' = -(t x n) = -(n_x cos(angle) + n_y sin(angle)),   n_x' = 0,   n_y' = Gamma = mu g L^3/B
//
// The angle is measured from straight down because cloth hangs: where it has nearly come to hang, the small
// angle keeps all its digits.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

namespace cloth::exact {

inline constexpr double pi = std::numbers::pi;
/// Directions of a tangent.
inline constexpr double downward = 0, rightward = pi / 2, upward = pi, leftward = 3 * pi / 2;

struct ElasticaPoint {
  double arc = 0, x = 0, y = 0;  ///< in L
  double angle = 0;              ///< rad, from straight down, counterclockwise
  double curvature = 0;          ///< 1/L
};

/// Force on the part of the strip before the start, by what is beyond it, and weight; B/L^2, B/L^3 per width.
struct ElasticaLoad {
  double horizontal = 0, vertical = 0;
  double weight = 0;  ///< Gamma; negative pulls up
};

/// `length` onwards from `start` by Runge-Kutta of order 4 in even steps; the start is the first point.
std::vector<ElasticaPoint> integrate_elastica(const ElasticaPoint& start, const ElasticaLoad& load,
                                              double length, int steps = 2000);

/// The last of those points alone.
ElasticaPoint end_of_elastica(const ElasticaPoint& start, const ElasticaLoad& load, double length,
                              int steps = 2000);

/// What has to vanish, as many as there are unknowns.
using Conditions = std::function<Eigen::VectorXd(const Eigen::VectorXd& unknowns)>;
using FamilyConditions = std::function<Eigen::VectorXd(double parameter, const Eigen::VectorXd& unknowns)>;

/// Newton's method with differences for derivatives; empty where it does not come down to rounding.
std::optional<Eigen::VectorXd> solve_by_newton(const Conditions& conditions, Eigen::VectorXd guess,
                                               int iterations = 60);

/// Along the solutions from one value of the parameter to another, in steps that Newton's method takes
/// quickly, so that it stays on the branch of `solution`, which holds at `from`.
std::optional<Eigen::VectorXd> follow_solution(const FamilyConditions& conditions, Eigen::VectorXd solution,
                                               double from, double to);

/// Where `f` vanishes between two values at which its signs differ (Illinois variant of regula falsi, Dowell
/// and Jarratt 1971).
double root_between(const std::function<double(double)>& f, double low, double high);

}  // namespace cloth::exact
