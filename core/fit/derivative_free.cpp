#include <nlopt.h>

#include <exception>
#include <memory>

#include "fit/fit_space.h"

namespace cloth {
namespace {

constexpr double smallest_step = 1e-5;  // of a coordinate
constexpr double no_value = 1e300;      // worse than any

struct Search {
  FitSpace& space;
  DescentEnd best;
  nlopt_opt solver;
  std::exception_ptr thrown{};  // NLopt is C: exceptions wait until it has returned
};

double value_at(unsigned count, const double* place, double*, void* data) {
  auto& search = *static_cast<Search*>(data);
  try {
    const Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(place, count);
    const auto residuals = search.space.residuals(u);
    const double chi = residuals ? search.space.chi_squared(*residuals) : no_value;
    if (residuals && chi < search.best.chi_squared) search.best = {search.best.status, u, *residuals, chi};
    return chi;
  } catch (...) {
    search.thrown = std::current_exception();
    nlopt_force_stop(search.solver);
    return no_value;
  }
}

}  // namespace

DescentEnd derivative_free(FitSpace& space, const Eigen::VectorXd& start, const Eigen::VectorXd& residuals,
                           std::size_t max_evaluations) {
  const auto count = static_cast<unsigned>(space.dimensions());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> solver(nlopt_create(NLOPT_LN_SBPLX, count),
                                                                 nlopt_destroy);
  Search search{space, {FitStatus::converged, start, residuals, space.chi_squared(residuals)}, solver.get()};
  std::vector<double> low, high, first;
  for (std::size_t j = 0; j < count; ++j) {
    low.push_back(space.low(j));
    high.push_back(space.high(j));
    first.push_back(0.1 * (high[j] - low[j]));
  }
  nlopt_set_min_objective(solver.get(), value_at, &search);
  nlopt_set_lower_bounds(solver.get(), low.data());
  nlopt_set_upper_bounds(solver.get(), high.data());
  nlopt_set_initial_step(solver.get(), first.data());
  nlopt_set_xtol_abs1(solver.get(), smallest_step);
  nlopt_set_maxeval(solver.get(), static_cast<int>(max_evaluations));
  std::vector<double> place(start.begin(), start.end());
  double least = 0;
  const nlopt_result ended = nlopt_optimize(solver.get(), place.data(), &least);
  if (search.thrown) std::rethrow_exception(search.thrown);
  if (ended == NLOPT_MAXEVAL_REACHED)
    search.best.status = FitStatus::max_iterations;
  else if (ended < 0 && ended != NLOPT_ROUNDOFF_LIMITED)
    search.best.status = FitStatus::stalled;
  return search.best;
}

}  // namespace cloth
