#include "limiter/interior_point.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cloth {
namespace {

/// Of an excess. The multipliers of a chain of taut springs add up to some hundred metres at most: their
/// violation, multiplier/rho, stays below a millionth of a cell.
constexpr double exact_penalty = 1e11;

/// Where the rate is unreachable: the compromise then minimises the excesses to within a thousandth.
constexpr double compromise_penalty = 1e4;

/// Times the largest violation at the start: multipliers above this mean that the rate is unreachable. A
/// chain of 65 particles that is 20 % too long has a thousand times.
constexpr double multiplier_bound = 1e6;

/// The part of the distance to the boundary that a step may take.
constexpr double to_boundary = 0.995;

constexpr int none = -1;

}  // namespace

InteriorPoint::InteriorPoint(const ClothSystem& system, std::vector<TensionSpring> springs,
                             const Vec3Field& start)
    : springs_(std::move(springs)) {
  shortest_ = springs_.front().rest_length;
  for (const TensionSpring& spring : springs_) {
    rest_.push_back(start[spring.second] - start[spring.first]);
    shortest_ = std::min(shortest_, spring.rest_length);
  }
  number_particles(system);
}

/// Numbers the particles of the working set in the elimination order of the whole cloth.
void InteriorPoint::number_particles(const ClothSystem& system) {
  std::vector<std::uint8_t> needed(system.pinned.size(), 0);
  for (const TensionSpring& spring : springs_) needed[spring.first] = needed[spring.second] = 1;
  std::vector<int> unknown(system.pinned.size(), none);
  const double mean_mass = system.total_mass() / system.size();
  for (const int i : elimination_order(system)) {
    const auto particle = static_cast<std::size_t>(i);
    if (!needed[particle]) continue;
    unknown[particle] = static_cast<int>(particle_.size());
    particle_.push_back(particle);
  }
  weight_.resize(static_cast<Eigen::Index>(particle_.size()));
  for (std::size_t k = 0; k < particle_.size(); ++k)
    weight_[static_cast<Eigen::Index>(k)] = system.mass[particle_[k]] / mean_mass;

  std::vector<Coupling> couplings;
  for (const TensionSpring& spring : springs_) {
    const int i = unknown[spring.first], j = unknown[spring.second];
    first_.push_back(i);
    second_.push_back(j);
    if (i != none && j != none) couplings.emplace_back(i, j);
  }
  std::vector<int> order(particle_.size());
  std::iota(order.begin(), order.end(), 0);
  factors_.analyse(couplings, order);
  diagonal_.resize(9 * particle_.size());
  coupling_.resize(9 * couplings.size());
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

/// Slacks and multipliers of the size of the largest violation, with the same product for every spring.
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

/// Stationarity, feasibility and complementarity, each far within the tolerance. Large multipliers, as of a
/// cloth stretched by many cells, scale the bound on the gradient.
bool InteriorPoint::is_minimum(double tolerance) const {
  const double size = 0.01 * tolerance * std::max(shortest_, multiplier_.maxCoeff());
  return gradient_.lpNorm<Eigen::Infinity>() <= size &&
         gap_.lpNorm<Eigen::Infinity>() <= 0.1 * tolerance * shortest_ &&
         multiplier_.dot(slack_) <= size * size * static_cast<double>(slack_.size());
}

/// w I + sum of (stiffness a a^T + multiplier/|d| (I - a a^T)) over the springs, always positive definite.
bool InteriorPoint::factorise() {
  using Block = Eigen::Map<Eigen::Matrix3d>;
  for (std::size_t k = 0; k < particle_.size(); ++k)
    Block(diagonal_.data() + 9 * k) = weight_[static_cast<Eigen::Index>(k)] * Eigen::Matrix3d::Identity();
  double* coupling = coupling_.data();
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    stiffness_[k] = 1 / (slack_[k] / multiplier_[k] + 1 / rho_);
    const double across = multiplier_[k] / std::max(length_[s], 0.1 * springs_[s].limit);
    const Vec3& a = direction_[s];
    const Eigen::Matrix3d block =
        across * Eigen::Matrix3d::Identity() + (stiffness_[k] - across) * a * a.transpose();
    const int i = first_[s], j = second_[s];
    if (i != none) Block(diagonal_.data() + 9 * i) += block;
    if (j != none) Block(diagonal_.data() + 9 * j) += block;
    if (i == none || j == none) continue;
    Block{coupling} = -block;
    coupling += 9;
  }
  return factors_.factorise(diagonal_, coupling_);
}

/// The Newton step toward multiplier * slack reduced by `complementarity`.
void InteriorPoint::find_direction(const Vector& complementarity) {
  const Vector target = gap_ - complementarity.cwiseQuotient(multiplier_);
  Vector right = -gradient_;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    add_pair(right, s, -stiffness_[k] * target[k] * direction_[s]);
  }
  step_ = right;
  factors_.solve({step_.data(), static_cast<std::size_t>(step_.size())}, 1);
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

bool InteriorPoint::is_infeasible(double tolerance) const {
  return multiplier_.maxCoeff() >
         std::max(rho_ * tolerance * shortest_, multiplier_bound * largest_violation_);
}

NearestShapeReport InteriorPoint::solve(double tolerance, bool reachable) {
  NearestShapeReport report;
  if (reachable) {
    rho_ = exact_penalty;
    report = iterate(tolerance, NearestShape::max_iterations);
    if (report.converged || !is_infeasible(tolerance)) return report;
  }
  rho_ = compromise_penalty;
  const NearestShapeReport compromise = iterate(tolerance, NearestShape::max_iterations - report.iterations);
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
    if (rho_ == exact_penalty && is_infeasible(tolerance)) return report;
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
