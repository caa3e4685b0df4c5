// The two iterative solvers: conjugate gradients, and minimal residuals for what is not symmetric.
#include <cmath>

#include "cloth/sums.h"
#include "integrators/implicit/linear_solver.h"

namespace cloth {
namespace {

constexpr int most_iterations = 2000;
constexpr int basis_size = 40;  // of minimal residuals, before a restart

double dot(const Vec3Field& a, const Vec3Field& b) {
  return cloth::dot(a.flat(), b.flat());
}

void add_scaled(double scale, const Vec3Field& from, Vec3Field& to) {
  const auto a = from.flat();
  const auto b = to.flat();
  for (std::size_t k = 0; k < b.size(); ++k) b[k] += scale * a[k];
}

void scale_by(double factor, Vec3Field& field) {
  for (double& value : field.flat()) value *= factor;
}

}  // namespace

KrylovReport conjugate_gradients(const LinearMap& matrix, const LinearMap& preconditioner,
                                 const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution) {
  KrylovReport report;
  Vec3Field residual = right_hand_side, image(residual.size()), conditioned(residual.size());
  solution.fill(0);
  preconditioner(residual, conditioned);
  Vec3Field direction = conditioned;
  double slope = dot(residual, conditioned);
  const double goal = tolerance * tolerance * slope;
  while (slope > goal && report.iterations < most_iterations) {
    matrix(direction, image);
    const double curvature = dot(direction, image);
    if (!(curvature > 0)) {
      report.indefinite = true;
      break;
    }
    const double length = slope / curvature;
    add_scaled(length, direction, solution);
    add_scaled(-length, image, residual);
    preconditioner(residual, conditioned);
    const double next = dot(residual, conditioned);
    scale_by(next / slope, direction);
    add_scaled(1, conditioned, direction);
    slope = next;
    ++report.iterations;
  }
  report.converged = !report.indefinite && slope <= goal && slope >= 0;
  return report;
}

namespace {

/// One cycle of minimal residuals: an orthonormal basis of the Krylov space by Arnoldi's process, its
/// Hessenberg matrix turned triangular by Givens rotations as it grows.
class ResidualCycle {
 public:
  ResidualCycle(const LinearMap& matrix, const LinearMap& preconditioner)
      : matrix_(matrix), preconditioner_(preconditioner) {}

  /// Adds the correction for `residual` to `solution`. Returns the iterations that it took to come under
  /// `goal`.
  int run(const Vec3Field& residual, double goal, Vec3Field& solution) {
    const double norm = std::sqrt(dot(residual, residual));
    basis_.assign(1, residual);
    scale_by(1 / norm, basis_.front());
    rotated_.assign(1, norm);
    columns_.clear(), cosines_.clear(), sines_.clear();
    while (static_cast<int>(columns_.size()) < basis_size && std::abs(rotated_.back()) > goal)
      if (!extend()) break;
    add_correction(solution);
    return static_cast<int>(columns_.size());
  }

 private:
  bool extend() {
    const std::size_t size = basis_.front().size();
    Vec3Field conditioned(size), next(size);
    preconditioner_(basis_.back(), conditioned);
    matrix_(conditioned, next);
    std::vector<double> column;
    for (const Vec3Field& other : basis_) {
      column.push_back(dot(next, other));
      add_scaled(-column.back(), other, next);
    }
    const double length = std::sqrt(dot(next, next));
    for (std::size_t k = 0; k < cosines_.size(); ++k) {
      const double above = column[k], below = column[k + 1];
      column[k] = cosines_[k] * above + sines_[k] * below;
      column[k + 1] = -sines_[k] * above + cosines_[k] * below;
    }
    const double pivot = std::hypot(column.back(), length);
    if (!(pivot > 0)) return false;
    cosines_.push_back(column.back() / pivot);
    sines_.push_back(length / pivot);
    column.back() = pivot;
    const double left = rotated_.back();
    rotated_.back() = cosines_.back() * left;
    rotated_.push_back(-sines_.back() * left);
    columns_.push_back(std::move(column));
    if (!(length > 0)) return false;
    scale_by(1 / length, next);
    basis_.push_back(std::move(next));
    return true;
  }

  void add_correction(Vec3Field& solution) const {
    std::vector<double> weights(columns_.size());
    for (std::size_t k = weights.size(); k-- > 0;) {
      double sum = rotated_[k];
      for (std::size_t later = k + 1; later < weights.size(); ++later)
        sum -= columns_[later][k] * weights[later];
      weights[k] = sum / columns_[k][k];
    }
    Vec3Field combined(solution.size()), conditioned(solution.size());
    for (std::size_t k = 0; k < weights.size(); ++k) add_scaled(weights[k], basis_[k], combined);
    preconditioner_(combined, conditioned);
    add_scaled(1, conditioned, solution);
  }

  const LinearMap& matrix_;
  const LinearMap& preconditioner_;
  std::vector<Vec3Field> basis_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> cosines_, sines_, rotated_;
};

}  // namespace

KrylovReport minimal_residuals(const LinearMap& matrix, const LinearMap& preconditioner,
                               const Vec3Field& right_hand_side, double tolerance, Vec3Field& solution) {
  constexpr int most_cycles = 5;
  KrylovReport report;
  solution.fill(0);
  const double goal = tolerance * std::sqrt(dot(right_hand_side, right_hand_side));
  Vec3Field residual = right_hand_side, image(residual.size());
  ResidualCycle cycle(matrix, preconditioner);
  for (int n = 0; n < most_cycles && std::sqrt(dot(residual, residual)) > goal; ++n) {
    report.iterations += cycle.run(residual, goal, solution);
    matrix(solution, image);
    residual = right_hand_side;
    add_scaled(-1, image, residual);
  }
  report.converged = std::sqrt(dot(residual, residual)) <= goal;
  return report;
}

}  // namespace cloth
