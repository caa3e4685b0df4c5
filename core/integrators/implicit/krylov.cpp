// The two iterative solvers: conjugate gradients, and minimal residuals for what is not symmetric.
#include <algorithm>
#include <cmath>

#include "integrators/implicit/linear_solver.h"
#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

constexpr int max_iterations = 2000, max_cycles = 400;
constexpr int basis_size = 40;  // of minimal residuals, before a restart

double inner_product(std::span<const double> a, std::span<const double> b) {
  return active_kernels<VectorKernels>().dot(a.data(), b.data(), a.size());
}

double dot(const Vec3Field& a, const Vec3Field& b) {
  return inner_product(a.flat(), b.flat());
}

void add_multiple(double scale, std::span<const double> from, std::span<double> to) {
  active_kernels<VectorKernels>().add_multiple(scale, from.data(), to.data(), to.size());
}

void add_multiple(double scale, const Vec3Field& from, Vec3Field& to) {
  add_multiple(scale, from.flat(), to.flat());
}

/// to = scale * to + from
void scale_and_add(double scale, std::span<const double> from, std::span<double> to) {
  active_kernels<VectorKernels>().scale_and_add(scale, from.data(), to.data(), to.size());
}

void scale_by(double factor, Vec3Field& field) {
  for (double& value : field.flat()) value *= factor;
}

}  // namespace

double ConjugateGradients::advance(double length, const BlockJacobi& preconditioner, Vec3Field& solution) {
  constexpr std::size_t stretch = 512;  // particles, whose numbers stay in the first cache
  double slope = 0;
  const std::size_t size = solution.size();
  for (std::size_t begin = 0; begin < size; begin += stretch) {
    const std::size_t count = std::min(stretch, size - begin), end = begin + count;
    for (std::size_t k = begin; k < begin + 3 * size; k += size) {
      add_multiple(length, direction_.flat().subspan(k, count), solution.flat().subspan(k, count));
      add_multiple(-length, image_.flat().subspan(k, count), residual_.flat().subspan(k, count));
    }
    multiply_blocks(preconditioner.inverse(), begin, end, residual_, conditioned_);
    for (std::size_t k = begin; k < begin + 3 * size; k += size)
      slope += inner_product(residual_.flat().subspan(k, count), conditioned_.flat().subspan(k, count));
  }
  return slope;
}

/// What pinned particles have in the residual means nothing: the preconditioner makes zero of it.
KrylovReport ConjugateGradients::solve(const ClothSystem& system, const Linearisation& matrix,
                                       const BlockJacobi& preconditioner, const Vec3Field& right_hand_side,
                                       double tolerance, Vec3Field& solution) {
  KrylovReport report;
  if (direction_.size() != solution.size()) conditioned_ = direction_ = image_ = Vec3Field(solution.size());
  residual_ = right_hand_side;
  solution.fill(0);
  direction_.fill(0);
  double slope = advance(0, preconditioner, solution);
  direction_ = conditioned_;
  const double goal = tolerance * tolerance * slope;
  while (slope > goal && report.iterations < max_iterations) {
    matrix.multiply_free(system, direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > 0)) {
      report.indefinite = true;
      report.reach = curvature < 0 ? -slope / curvature : 0;
      break;
    }
    const double next = advance(slope / curvature, preconditioner, solution);
    scale_and_add(next / slope, conditioned_.flat(), direction_.flat());
    slope = next;
    ++report.iterations;
  }
  report.converged = !report.indefinite && slope <= goal && slope >= 0;
  return report;
}

/// With z = B r after the step r' = r - a q: beta = (r' - r) . z / r . z_before = -a q . z / (r . z_before).
KrylovReport ConjugateGradients::solve(const ClothSystem& system, const Linearisation& matrix,
                                       const LinearMap& preconditioner, const Vec3Field& right_hand_side,
                                       double tolerance, Vec3Field& solution) {
  KrylovReport report;
  if (direction_.size() != solution.size()) conditioned_ = direction_ = image_ = Vec3Field(solution.size());
  residual_ = right_hand_side;
  solution.fill(0);
  preconditioner(residual_, conditioned_);
  direction_ = conditioned_;
  double slope = dot(residual_, conditioned_);
  const double goal = tolerance * tolerance * slope;
  while (slope > goal && report.iterations < max_cycles) {
    matrix.multiply(system, direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > 0)) {
      report.indefinite = true;
      report.reach = curvature < 0 ? -slope / curvature : 0;
      break;
    }
    const double length = slope / curvature;
    add_multiple(length, direction_, solution);
    add_multiple(-length, image_, residual_);
    preconditioner(residual_, conditioned_);
    const double turn = -length * dot(image_, conditioned_) / slope;
    scale_and_add(turn, conditioned_.flat(), direction_.flat());
    slope = dot(residual_, conditioned_);
    ++report.iterations;
  }
  report.converged = !report.indefinite && slope <= goal && slope >= 0;
  return report;
}

/// One cycle: an orthonormal basis of the Krylov space by Arnoldi's process, its Hessenberg matrix turned
/// triangular by Givens rotations as it grows. Returns the iterations that it took to come under `goal`.
int MinimalResiduals::run_cycle(const LinearMap& matrix, const LinearMap& preconditioner, double goal,
                                Vec3Field& solution) {
  const double norm = std::sqrt(dot(residual_, residual_));
  take_basis(0) = residual_;
  scale_by(1 / norm, basis_.front());
  rotated_.assign(1, norm);
  columns_.clear(), cosines_.clear(), sines_.clear();
  while (static_cast<int>(columns_.size()) < basis_size && std::abs(rotated_.back()) > goal) {
    preconditioner(basis_[columns_.size()], conditioned_);
    matrix(conditioned_, take_basis(columns_.size() + 1));
    if (!extend()) break;
  }
  add_correction(preconditioner, solution);
  return static_cast<int>(columns_.size());
}

Vec3Field& MinimalResiduals::take_basis(std::size_t number) {
  if (basis_.size() <= number) basis_.resize(number + 1);
  if (basis_[number].size() != residual_.size()) basis_[number] = Vec3Field(residual_.size());
  return basis_[number];
}

bool MinimalResiduals::extend() {
  Vec3Field& next = basis_[columns_.size() + 1];
  std::vector<double> column;
  for (std::size_t k = 0; k <= columns_.size(); ++k) {
    column.push_back(dot(next, basis_[k]));
    add_multiple(-column.back(), basis_[k], next);
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
  return true;
}

void MinimalResiduals::add_correction(const LinearMap& preconditioner, Vec3Field& solution) {
  std::vector<double> weights(columns_.size());
  for (std::size_t k = weights.size(); k-- > 0;) {
    double sum = rotated_[k];
    for (std::size_t later = k + 1; later < weights.size(); ++later)
      sum -= columns_[later][k] * weights[later];
    weights[k] = sum / columns_[k][k];
  }
  combined_.fill(0);
  for (std::size_t k = 0; k < weights.size(); ++k) add_multiple(weights[k], basis_[k], combined_);
  preconditioner(combined_, conditioned_);
  add_multiple(1, conditioned_, solution);
}

KrylovReport MinimalResiduals::solve(const LinearMap& matrix, const LinearMap& preconditioner,
                                     const Vec3Field& right_hand_side, double tolerance,
                                     Vec3Field& solution) {
  constexpr int max_cycles = 5;
  KrylovReport report;
  const double goal = tolerance * std::sqrt(dot(right_hand_side, right_hand_side));
  if (image_.size() != solution.size()) image_ = conditioned_ = combined_ = Vec3Field(solution.size());
  const auto find_residual = [&] {
    matrix(solution, image_);
    residual_ = right_hand_side;
    add_multiple(-1, image_, residual_);
    return std::sqrt(dot(residual_, residual_));
  };
  double norm = find_residual();
  for (int n = 0; n < max_cycles && norm > goal; ++n) {
    report.iterations += run_cycle(matrix, preconditioner, goal, solution);
    norm = find_residual();
  }
  report.converged = norm <= goal;
  return report;
}

}  // namespace cloth
