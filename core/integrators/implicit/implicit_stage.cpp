#include "integrators/implicit/implicit_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cloth/sums.h"

namespace cloth {
namespace {

constexpr double tightest_forcing = 1e-4, loosest_forcing = 0.1;
constexpr double accepted_work = 0.5;   // of the residual along a step that is long enough
constexpr int max_trials = 13;          // of a length
constexpr int most_patience = 24;       // iterations, before the residual's norm is lowered a last time
constexpr int slow = 5;                 // iterations that are many
constexpr double nearly_solved = 0.01;  // relative change from which on another iteration may be spared
constexpr double estimate_part = 0.01;  // of the tolerance: what is estimated is up to a hundredfold too low
constexpr double good_enough = 1e-3;    // relative change after the last iteration that is still taken

double largest_component(const Vec3Field& field) {
  double largest = 0;
  for (const double value : field.flat()) {
    if (!(std::abs(value) <= std::numeric_limits<double>::max()))
      return value;  // not finite: seen by callers
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

int place_of_largest(const Vec3Field& field) {
  int at = 0;
  double largest = -1;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double size = field[i].norm();
    if (!std::isfinite(size)) return static_cast<int>(i);
    if (size > largest) largest = size, at = static_cast<int>(i);
  }
  return at;
}

void clear_pinned(const ClothSystem& system, Vec3Field& field) {
  for (std::size_t i = 0; i < field.size(); ++i)
    if (system.pinned[i]) field.set(i, Vec3::Zero());
}

double norm_of(const Vec3Field& field) {
  return std::sqrt(dot(field.flat(), field.flat()));
}

void set_negative(const Vec3Field& field, Vec3Field& negative) {
  negative = field;
  for (double& value : negative.flat()) value = -value;
}

/// sum = from + scale * along
void set_sum(const Vec3Field& from, double scale, const Vec3Field& along, Vec3Field& sum) {
  if (sum.size() != from.size()) sum = Vec3Field(from.size());
  const std::span<const double> a = from.flat(), b = along.flat();
  const std::span<double> c = sum.flat();
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = a[k] + scale * b[k];
}

double work_along(const Vec3Field& direction, const Vec3Field& residual) {
  return dot(direction.flat(), residual.flat());
}

}  // namespace

void ImplicitStage::evaluate(const StageEquation& e) {
  set_sum(e.start_position, e.weight, e.velocity, e.position);
  e.forces.update(e.position, e.time);
  e.forces.force(e.position, e.velocity, force_);
  ++e.report.force_evaluations;
  const std::vector<double>& mass = e.forces.system().mass;
  const std::span<const double> v = e.velocity.flat(), v0 = e.start_velocity.flat(), f = force_.flat();
  const std::span<double> r = residual_.flat();
  for (std::size_t axis = 0; axis < r.size(); axis += mass.size())
    for (std::size_t i = 0, k = axis; i < mass.size(); ++i, ++k)
      r[k] = mass[i] * (v[k] - v0[k]) - e.weight * f[k];
  clear_pinned(e.forces.system(), residual_);
}

/// How far an iterative solve goes within an iteration of Newton's method: no further than the linear model
/// is worth, which the last fall of the residual tells (Eisenstat and Walker 1996, choice 2). Convergence
/// stays superlinear, and becomes quadratic where the tightest value is reached. A whole step that made the
/// residual fall far has changed the matrix little, and its cycle serves once more.
void ImplicitStage::choose_forcing() {
  constexpr double weight = 0.9, far = 0.1;
  const double norm = norm_of(residual_), fall = residual_norm_ > 0 ? norm / residual_norm_ : 1;
  forcing_ = std::clamp(weight * fall * fall, tightest_forcing, loosest_forcing);
  if (residual_norm_ > 0 && !(length_ == 1 && fall <= far)) has_cycle_ = false;
  residual_norm_ = norm;
}

bool ImplicitStage::solve_by_factors(const StageEquation& e) {
  ++e.report.factorisations;
  if (!factors_.factorise(e.forces.system(), linearisation_)) return false;
  factors_.solve(negative_residual_, downhill_);
  return true;
}

void ImplicitStage::keep_escape(const KrylovReport& krylov) {
  if (!krylov.indefinite) return;
  escape_ = gradients_.direction();
  for (double& value : escape_.flat()) value *= krylov.reach;
}

/// downhill = -A^-1 residual with the linearisation at hand; false where A is not positive definite, or where
/// conjugate gradients did not get there.
bool ImplicitStage::solve_symmetric(const StageEquation& e, LinearMethod method) {
  linear_method_ = method;
  if (linear_method_ == LinearMethod::cholesky) return solve_by_factors(e);
  jacobi_.prepare(e.forces.system(), linearisation_);
  const KrylovReport krylov =
      gradients_.solve(e.forces.system(), linearisation_, jacobi_, negative_residual_, forcing_, downhill_);
  e.report.linear_iterations += krylov.iterations;
  keep_escape(krylov);
  return krylov.converged;
}

/// A cycle of multigrid of the clamped matrix where the cloth is now; false where there is none.
bool ImplicitStage::make_cycle(const StageEquation& e) {
  const LinearisationWeights weights{.position = e.weight * e.weight, .velocity = e.weight, .clamped = true};
  e.forces.linearise(e.position, weights, clamped_);
  return multigrid_.prepare(e.forces.system(), clamped_, e.position);
}

/// The same by conjugate gradients with a cycle of multigrid of the clamped matrix: with the exact matrix,
/// and where that is not positive definite with the clamped one. A cycle that is at hand serves, unless it
/// does not solve.
bool ImplicitStage::solve_by_multigrid(const StageEquation& e) {
  const ClothSystem& system = e.forces.system();
  const bool clamps = linearisation_.has_compressed;
  const LinearMap preconditioner = [&](const Vec3Field& in, Vec3Field& out) {
    multigrid_.precondition(in, out);
  };
  const auto solve_with = [&](const Linearisation& matrix) {
    const KrylovReport krylov =
        gradients_.solve(system, matrix, preconditioner, negative_residual_, forcing_, downhill_);
    e.report.linear_iterations += krylov.iterations;
    keep_escape(krylov);
    return krylov;
  };
  linear_method_ = LinearMethod::multigrid;
  if (has_cycle_ && solve_with(linearisation_).converged) return true;
  has_cycle_ = false;
  if (clamps ? !make_cycle(e) : !multigrid_.prepare(system, linearisation_, e.position)) return false;
  const KrylovReport exact = solve_with(linearisation_);
  has_cycle_ = exact.converged;
  return exact.indefinite && clamps ? solve_with(clamped_).converged : exact.converged;
}

/// Factors of an indefinite matrix show no direction that curves downwards. Conjugate gradients do, and are
/// tried with a cycle, as long as that solves.
void ImplicitStage::find_direction(const StageEquation& e) {
  const double h = e.weight;
  LinearisationWeights weights{.position = h * h, .velocity = h, .clamped = false};
  e.forces.linearise(e.position, weights, linearisation_);
  const LinearMethod method = choose_linear_method(e.forces.system(), weights).method;
  set_negative(residual_, negative_residual_);
  escape_.fill(0);
  bool solved = method == LinearMethod::multigrid ? solve_by_multigrid(e) : solve_symmetric(e, method);
  if (!solved || largest_component(escape_) > 0) is_indefinite_ = true;
  if (!solved && method == LinearMethod::cholesky && cycles_solve_)
    solved = cycles_solve_ = solve_by_multigrid(e);
  if (!solved) {
    weights.clamped = true;
    e.forces.linearise(e.position, weights, linearisation_);
    const bool again = method != LinearMethod::multigrid && solve_symmetric(e, method);
    if (!again) solve_symmetric(e, LinearMethod::cholesky);
  }
  direction_ = downhill_;
  const bool can_relax =
      futile_left_ > 0 && (MultigridSolver::suits(e.forces.system()) || has_preconditioner());
  const bool relaxes = can_relax && largest_component(escape_) > 0;  // which needs no exact direction
  if (e.forces.has_asymmetric_part() && !relaxes) correct_direction(e);
  add_escape();
}

/// direction -= J^-1 (J direction + residual) with the whole Jacobian, to `tolerance` times the residual.
void ImplicitStage::solve_whole(const StageEquation& e, LinearMethod method, double tolerance) {
  const LinearMap jacobian = [&](const Vec3Field& in, Vec3Field& out) {
    linearisation_.multiply(e.forces.system(), in, out);
    e.forces.asymmetric_product(e.position, e.velocity, in, turned_);
    add_scaled(e.weight * e.weight, turned_, out);
    clear_pinned(e.forces.system(), out);
  };
  e.report.linear_iterations +=
      minimal_residuals_.solve(jacobian, preconditioner(method), negative_residual_, tolerance, direction_)
          .iterations;
}

/// From the direction of the symmetric part to that of the whole Jacobian, unless that goes uphill.
void ImplicitStage::correct_direction(const StageEquation& e) {
  solve_whole(e, linear_method_, forcing_);
  if (!(work_along(direction_, residual_) < 0)) direction_ = downhill_;
}

/// Near a saddle the clamped matrix hardly moves along what curves downwards, however far that leads: so the
/// direction of negative curvature that conjugate gradients met is gone along as well, by its own curvature.
void ImplicitStage::add_escape() {
  constexpr double furthest = 4;  // times the rest of the step
  const double reach = largest_component(escape_);
  if (!(reach > 0)) return;
  const double allowed = furthest * largest_component(direction_);
  const double downwards = work_along(escape_, residual_) < 0 ? 1 : -1;
  add_scaled(downwards * std::min(1.0, allowed / reach), escape_, direction_);
}

/// Goes along the direction until the residual's work along it has fallen to the part `accepted`: less far
/// where it has turned against the direction, further where it has hardly fallen, as on the way off a saddle.
/// False where it is not finite at last.
bool ImplicitStage::find_length(const StageEquation& e, double accepted) {
  start_ = e.velocity;
  const double before = work_along(direction_, residual_);
  double near = 0, near_work = before;  // the longest step that was too short
  std::optional<double> far;            // the shortest that was too long, and its work
  double far_work = 0;
  length_ = 1;
  for (int trial = 1;; ++trial) {
    set_sum(start_, length_, direction_, e.velocity);
    evaluate(e);
    const double after = work_along(direction_, residual_);
    if (std::abs(after) <= accepted * std::abs(before) || trial == max_trials) return std::isfinite(after);
    if (after < 0) {
      near = length_, near_work = after;
    } else {
      far = length_, far_work = after;
    }
    if (far) {
      const double secant = std::isfinite(far_work) ? near_work / (near_work - far_work) : 0;
      length_ = near + (*far - near) * std::clamp(secant, 0.1, 0.5);
    } else {
      length_ *= 2;
    }
  }
}

/// Returns the largest change.
double ImplicitStage::take_step(const StageEquation& e) {
  find_length(e, accepted_work);
  return length_ * largest_component(direction_);
}

/// About the inverse of the matrix that the method solved with last.
LinearMap ImplicitStage::preconditioner(LinearMethod method) {
  return [this, method](const Vec3Field& in, Vec3Field& out) {
    if (method == LinearMethod::cholesky) return factors_.solve(in, out);
    if (method == LinearMethod::multigrid) return multigrid_.precondition(in, out);
    jacobi_.solve(in, out);
  };
}

/// Lowers the residual by limited memory until its work along the direction is a 1e8th of the first. The
/// preconditioner is a cycle of multigrid, made anew as the cloth moves, or the last iteration's factors. It
/// knows nothing of how much longer a spring gets by turning, and its steps are mostly too long at first: so
/// a loose condition ends each line search.
void ImplicitStage::relax(const StageEquation& e) {
  constexpr int steps_of_cycle = 15;
  constexpr double fall = 1e-8, accepted = 0.9, little = 0.1;
  const bool has_cycles = MultigridSolver::suits(e.forces.system());
  if (!has_cycles && !has_preconditioner()) return;
  const LinearMap inverse = preconditioner(has_cycles ? LinearMethod::multigrid : linear_method_);
  const int most_steps = std::min(3000, futile_left_);
  double first = 0, last = 0, length = 0;
  int n = 0;
  for (; n < most_steps; ++n) {
    if (has_cycles && n % steps_of_cycle == 0) {
      has_cycle_ = make_cycle(e);
      if (!has_cycle_) break;
    }
    memory_.next(residual_, length, inverse, direction_);
    ++e.report.linear_iterations;
    last = -work_along(direction_, residual_);
    if (n == 0) first = last;
    if (!(last > fall * first)) break;
    if (!find_length(e, accepted)) {
      e.velocity = start_;
      evaluate(e);
      memory_.forget();
      break;
    }
    length = length_;
  }
  if (!(last < little * first)) futile_left_ -= n + 1;
  residual_norm_ = 0;  // no iteration of Newton's method made it fall
}

/// Newton's method with the whole Jacobian, each step gone as far as the residual's norm falls (Eisenstat and
/// Walker 1994). Wind and dampers have no potential, and the symmetric part of the Jacobian may be indefinite
/// at the solution: what goes downhill, or along negative curvature, then leads away from there, and around.
/// True where a step changes no velocity by more than `smallest_change`.
bool ImplicitStage::lower_norm(const StageEquation& e, double smallest_change) {
  constexpr int most_steps = 100, stretch = 10;
  constexpr double tolerance = 1e-3, least_fall = 1e-3, shortest = 1e-3, least_fall_of_stretch = 0.1;
  const LinearisationWeights weights{.position = e.weight * e.weight, .velocity = e.weight, .clamped = false};
  has_cycle_ = false;
  residual_norm_ = 0;
  double norm = norm_of(residual_), norm_of_stretch = std::numeric_limits<double>::infinity();
  for (int n = 0; n < most_steps; ++n, norm = norm_of(residual_)) {
    if (n % stretch == 0 && !(norm <= (1 - least_fall_of_stretch) * std::exchange(norm_of_stretch, norm)))
      return false;
    if (!make_cycle(e)) return false;
    e.forces.linearise(e.position, weights, linearisation_);
    set_negative(residual_, negative_residual_);
    direction_.fill(0);
    solve_whole(e, LinearMethod::multigrid, tolerance);
    ++e.report.iterations;
    const bool is_last = largest_component(direction_) <= smallest_change;
    start_ = e.velocity;
    for (length_ = 1;; length_ *= 0.5) {
      if (length_ < shortest) length_ = 0;
      set_sum(start_, length_, direction_, e.velocity);
      evaluate(e);
      if (is_last) return true;
      if (length_ == 0) return false;
      if (norm_of(residual_) <= (1 - least_fall * length_) * norm) break;
    }
  }
  return false;
}

/// Whether a further iteration would change no velocity by more than `largest_change`, by what the last one's
/// solver makes of the residual that is left. A step that was shortened says nothing.
bool ImplicitStage::is_solved(const StageEquation& e, double largest_change) {
  if (length_ != 1) return false;
  preconditioner(linear_method_)(residual_, downhill_);
  ++e.report.linear_iterations;
  return largest_component(downhill_) <= largest_change;
}

void ImplicitStage::solve(const StageEquation& e) {
  guess_ = e.velocity;
  if (iterate(e, e.forces.has_normals())) return;
  ++e.report.held_normals;
  e.velocity = guess_;
  e.forces.update(e.start_position, e.time);
  e.forces.hold_normals(true);
  iterate(e, false);
  e.forces.hold_normals(false);
}

/// Iterations of Newton's method, until the equation is solved or has failed, which the report says. False:
/// neither, but nothing has led to a solution; only if it `may_give_up`. Forces that are not finite have
/// failed: they would be so with other normals too.
bool ImplicitStage::iterate(const StageEquation& e, bool may_give_up) {
  const std::size_t size = e.velocity.size();
  if (force_.size() != size)
    force_ = residual_ = downhill_ = direction_ = escape_ = start_ = turned_ = Vec3Field(size);
  evaluate(e);

  // Positions are rounded to eps |x|: velocities that differ by eps |x| / h are the same.
  const double rounding =
      64 * std::numeric_limits<double>::epsilon() * largest_component(e.position) / e.weight;
  double scale = std::max(largest_component(e.velocity), largest_component(e.start_velocity));
  double relative = 0;
  residual_norm_ = 0;
  has_cycle_ = is_indefinite_ = false;
  cycles_solve_ = MultigridSolver::suits(e.forces.system());
  futile_left_ = e.forces.has_asymmetric_part() ? 2000 : 4000;  // wind has no potential to fall in
  int patience = 6;  // iterations, before the residual's norm is lowered
  memory_.forget();
  for (int n = 0; n < max_iterations_; ++n) {
    choose_forcing();
    find_direction(e);
    const double change = take_step(e);
    ++e.report.iterations;
    if (!std::isfinite(change) || !std::isfinite(largest_component(residual_))) {
      e.report.failure = {place_of_largest(residual_),
                          "the forces of an iteration of Newton's method are not finite"};
      return true;
    }
    scale = std::max(scale, largest_component(e.velocity));
    relative = change > 0 ? change / scale : 0;
    if (change <= tolerance_ * scale + rounding) {
      e.report.residual = std::max(e.report.residual, relative);
      return true;
    }
    const bool turns_far = largest_component(escape_) > 0 || (length_ < 1 && is_indefinite_);
    const bool is_near = change <= nearly_solved * scale;
    const bool is_slow = n + 1 >= slow && !is_near;
    if ((turns_far || is_slow) && futile_left_ > 0) relax(e);
    if (n + 1 >= patience && patience <= most_patience && !is_near && e.forces.has_asymmetric_part() &&
        MultigridSolver::suits(e.forces.system())) {
      if (lower_norm(e, tolerance_ * scale + rounding)) return true;
      while (patience <= n + 1) patience *= 2;
    }
    if (may_give_up && patience > most_patience && n + 1 >= most_patience && !is_near) return false;
    if (is_near && has_preconditioner() && is_solved(e, estimate_part * tolerance_ * scale + rounding))
      return true;
  }
  if (may_give_up && !(relative <= good_enough)) return false;
  e.report.residual = std::max(e.report.residual, relative);
  if (relative <= good_enough) return true;
  e.report.failure = {
      place_of_largest(residual_),
      fmt::format("Newton's method did not converge: after {} iterations the velocities still "
                  "change by {:.2g} of the largest",
                  max_iterations_, relative)};
  return true;
}

}  // namespace cloth
