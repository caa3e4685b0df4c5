#include "limiter/interior_point.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <utility>

namespace cloth {
namespace {

/// A chain of taut springs adds up multipliers of at most some hundred metres: their violation,
/// multiplier/rho, stays below a millionth of a cell.
constexpr double forbidding = 1e11;

/// Where the rate is out of reach: the compromise is then one of excesses alone to within a thousandth.
constexpr double dear = 1e4;

/// Times the largest violation at the start: multipliers that no reachable rate needs. A chain of 65
/// particles that is 20 % too long asks for a thousand times.
constexpr double beyond_need = 1e6;

/// The part of the way to the boundary that a step may take.
constexpr double to_boundary = 0.995;

constexpr Eigen::Index none = -1;

}  // namespace

InteriorPoint::InteriorPoint(const ClothSystem& system, std::vector<LimitedSpring> springs,
                             const Vec3Field& start)
    : springs_(std::move(springs)) {
  shortest_ = springs_.front().rest_length;
  for (const LimitedSpring& spring : springs_) {
    rest_.push_back(start[spring.j] - start[spring.i]);
    shortest_ = std::min(shortest_, spring.rest_length);
  }
  order_particles(system);
}

/// Eliminates particles, not components, in the order of approximate minimum degree: a graph of a ninth of
/// the entries.
void InteriorPoint::order_particles(const ClothSystem& system) {
  std::vector<int> unknown(system.pinned.size(), static_cast<int>(none));
  std::vector<std::size_t> found;
  for (const LimitedSpring& spring : springs_) {
    for (const std::size_t end : {spring.i, spring.j}) {
      if (system.pinned[end] || unknown[end] != none) continue;
      unknown[end] = static_cast<int>(found.size());
      found.push_back(end);
    }
  }
  const int count = static_cast<int>(found.size());
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int k = 0; k < count; ++k) entries.emplace_back(k, k, 1.0);
  for (const LimitedSpring& spring : springs_) {
    const int a = unknown[spring.i], b = unknown[spring.j];
    if (a == none || b == none) continue;
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  Matrix graph(count, count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);

  particle_.resize(found.size());
  weight_.resize(count);
  const double mean_mass = system.total_mass() / system.size();
  for (int k = 0; k < count; ++k) {
    const std::size_t particle = found[static_cast<std::size_t>(order.indices()[k])];
    particle_[static_cast<std::size_t>(k)] = particle;
    unknown[particle] = k;
    weight_[k] = system.mass[particle] / mean_mass;
  }
  for (const LimitedSpring& spring : springs_) {
    first_.push_back(unknown[spring.i]);
    second_.push_back(unknown[spring.j]);
  }
}

Vec3 InteriorPoint::difference(const Vector& of, std::size_t s) const {
  Vec3 result = Vec3::Zero();
  if (second_[s] != none) result += of.segment<3>(3 * second_[s]);
  if (first_[s] != none) result -= of.segment<3>(3 * first_[s]);
  return result;
}

void InteriorPoint::add_pair(Vector& to, std::size_t s, const Vec3& amount) const {
  if (second_[s] != none) to.segment<3>(3 * second_[s]) += amount;
  if (first_[s] != none) to.segment<3>(3 * first_[s]) -= amount;
}

/// Slacks and multipliers of the size of the largest violation: the product is the same for every spring.
void InteriorPoint::start() {
  const auto count = static_cast<Eigen::Index>(springs_.size());
  displacement_ = Vector::Zero(3 * weight_.size());
  slack_.resize(count), multiplier_.resize(count), gap_.resize(count), stiffness_.resize(count);
  direction_.resize(springs_.size());
  length_.resize(springs_.size());
  double& largest = largest_violation_ = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s)
    largest = std::max(largest, rest_[s].norm() - springs_[s].limit);
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    slack_[k] = std::max(springs_[s].limit - rest_[s].norm(), largest);
    multiplier_[k] = largest * largest / slack_[k];
  }
}

void InteriorPoint::evaluate() {
  gradient_.resize(displacement_.size());
  for (Eigen::Index k = 0; k < weight_.size(); ++k)
    gradient_.segment<3>(3 * k) = weight_[k] * displacement_.segment<3>(3 * k);
  excess_ = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    const Vec3 d = rest_[s] + difference(displacement_, s);
    length_[s] = d.norm();
    direction_[s] = length_[s] > 0 ? Vec3(d / length_[s]) : Vec3(Vec3::Zero());
    const double over = length_[s] - springs_[s].limit;
    gap_[k] = over + slack_[k] - multiplier_[k] / rho_;
    excess_ = std::max(excess_, over / springs_[s].rest_length);
    add_pair(gradient_, s, multiplier_[k] * direction_[s]);
  }
}

/// Stationary, on the constraints, and complementary, each far within the tolerance. A cloth pulled through
/// by many cells has large multipliers, and its displacements are judged by those.
bool InteriorPoint::is_minimum(double tolerance) const {
  const double size = 0.01 * tolerance * std::max(shortest_, multiplier_.maxCoeff());
  return gradient_.lpNorm<Eigen::Infinity>() <= size &&
         gap_.lpNorm<Eigen::Infinity>() <= 0.1 * tolerance * shortest_ &&
         multiplier_.dot(slack_) <= size * size * static_cast<double>(slack_.size());
}

/// w I + sum of (stiffness a a^T + multiplier/|d| (I - a a^T)) over the springs: positive definite whatever
/// the springs say.
bool InteriorPoint::factorise() {
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(static_cast<std::size_t>(6 * weight_.size()) + 21 * springs_.size());
  const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        if (3 * row + r >= 3 * column + c) entries.emplace_back(3 * row + r, 3 * column + c, block(r, c));
  };
  for (int k = 0; k < weight_.size(); ++k) add(k, k, weight_[k] * Eigen::Matrix3d::Identity());
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    stiffness_[k] = 1 / (slack_[k] / multiplier_[k] + 1 / rho_);
    const double across = multiplier_[k] / std::max(length_[s], 0.1 * springs_[s].limit);
    const Vec3& a = direction_[s];
    const Eigen::Matrix3d block =
        across * Eigen::Matrix3d::Identity() + (stiffness_[k] - across) * a * a.transpose();
    const int i = first_[s], j = second_[s];
    if (i != none) add(i, i, block);
    if (j != none) add(j, j, block);
    if (i != none && j != none) add(std::max(i, j), std::min(i, j), -block);
  }
  Matrix matrix(displacement_.size(), displacement_.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  if (!analysed_) solver_.analyzePattern(matrix);
  analysed_ = true;
  solver_.factorize(matrix);
  return solver_.info() == Eigen::Success;
}

/// The Newton step toward multiplier * slack reduced by `complementarity`.
void InteriorPoint::find_direction(const Vector& complementarity) {
  const Vector target = gap_ - complementarity.cwiseQuotient(multiplier_);
  Vector right = -gradient_;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    add_pair(right, s, -stiffness_[k] * target[k] * direction_[s]);
  }
  step_ = solver_.solve(right);
  multiplier_step_.resize(slack_.size());
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    multiplier_step_[k] = stiffness_[k] * (direction_[s].dot(difference(step_, s)) + target[k]);
  }
  slack_step_ = -(complementarity + slack_.cwiseProduct(multiplier_step_)).cwiseQuotient(multiplier_);
}

/// The longest step, at most 1, that leaves slacks and multipliers `1 - fraction` of what they are.
double InteriorPoint::step_length(double fraction) const {
  double length = 1;
  for (Eigen::Index k = 0; k < slack_.size(); ++k) {
    if (slack_step_[k] < 0) length = std::min(length, -fraction * slack_[k] / slack_step_[k]);
    if (multiplier_step_[k] < 0) length = std::min(length, -fraction * multiplier_[k] / multiplier_step_[k]);
  }
  return length;
}

void InteriorPoint::take_step() {
  const auto count = static_cast<double>(slack_.size());
  const Vector products = multiplier_.cwiseProduct(slack_);
  find_direction(products);  // predictor: how far would the product fall to 0?
  const double ahead = step_length(1);
  const double mean = products.sum() / count;
  const double reached = (multiplier_ + ahead * multiplier_step_).dot(slack_ + ahead * slack_step_) / count;
  const double centring = std::pow(reached / mean, 3);
  const Vector second = multiplier_step_.cwiseProduct(slack_step_);
  find_direction((products + second).array() - centring * mean);
  const double length = step_length(to_boundary);
  displacement_ += length * step_;
  slack_ += length * slack_step_;
  multiplier_ += length * multiplier_step_;
}

bool InteriorPoint::has_no_shape(double tolerance) const {
  return multiplier_.maxCoeff() > std::max(rho_ * tolerance * shortest_, beyond_need * largest_violation_);
}

NearestShapeReport InteriorPoint::solve(double tolerance, bool reachable) {
  NearestShapeReport report;
  if (reachable) {
    rho_ = forbidding;
    report = iterate(tolerance, NearestShape::most_iterations);
    if (report.converged || !has_no_shape(tolerance)) return report;
  }
  rho_ = dear;
  const NearestShapeReport compromise = iterate(tolerance, NearestShape::most_iterations - report.iterations);
  return {report.iterations + compromise.iterations, compromise.excess, compromise.converged};
}

NearestShapeReport InteriorPoint::iterate(double tolerance, int most) {
  start();
  evaluate();
  NearestShapeReport report{0, excess_, is_minimum(tolerance)};
  Vector best = displacement_, best_multiplier = multiplier_;
  while (!report.converged && report.iterations < most) {
    ++report.iterations;
    if (!factorise()) break;
    take_step();
    evaluate();
    if (!displacement_.allFinite() || !multiplier_.allFinite()) break;
    if (rho_ == forbidding && has_no_shape(tolerance)) return report;
    report.converged = is_minimum(tolerance);
    if (!report.converged && excess_ > report.excess) continue;
    report.excess = excess_;
    best = displacement_;
    best_multiplier = multiplier_;
  }
  displacement_ = best;
  multiplier_ = best_multiplier;
  return report;
}

void InteriorPoint::displace(Vec3Field& position) const {
  for (std::size_t k = 0; k < particle_.size(); ++k)
    position.add(particle_[k], displacement_.segment<3>(3 * static_cast<Eigen::Index>(k)));
}

}  // namespace cloth
