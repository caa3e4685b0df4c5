#include "contact/rate_tensions.h"

#include <algorithm>

#include "limiter/tension_springs.h"

namespace cloth {

RateTensions::RateTensions(const Deformation& deformation, const ClothSystem& system) {
  const double membrane = stiffest_edge(system.membrane);
  for_each_spring(system.springs,
                  [&](const SpringRun& run, std::size_t spring, std::size_t i, std::size_t j) {
                    const double length = run.rest_length;
                    if (!is_limited(deformation, run.family) || !(length > 0)) return;
                    springs_.push_back({.first = i,
                                        .second = j,
                                        .spring = spring,
                                        .longest = (1 + deformation.rate) * length,
                                        .accepted = (1 + deformation.rate + deformation.tolerance) * length,
                                        .resistance = run.stiffness > 0 ? run.stiffness : membrane,
                                        .mass = std::max(system.mass[i], system.mass[j])});
                  });
}

void RateTensions::begin(double weight) {
  constexpr double part = 4;
  weight_ = weight;
  for (Limited& spring : springs_)
    spring.penalty = part * (spring.resistance + spring.mass / (weight * weight));
  tension_.assign(springs_.size(), 0.0);
}

bool RateTensions::keeps(const Vec3Field& position) const {
  return std::all_of(springs_.begin(), springs_.end(), [&](const Limited& spring) {
    return difference(spring, position).norm() <= spring.accepted;
  });
}

double RateTensions::tension_at(std::size_t s, double length) const {
  return std::max(0.0, tension_[s] + springs_[s].penalty * (length - springs_[s].longest));
}

/// visit(spring, d, |d|, t(x)) for every spring with a tension.
template <class Visit>
void RateTensions::for_each_taut(const Vec3Field& position, Visit visit) const {
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const Vec3 d = difference(springs_[s], position);
    const double length = d.norm(), tension = tension_at(s, length);
    if (tension > 0) visit(springs_[s], d, length, tension);
  }
}

void RateTensions::add_force(const Vec3Field& position, Vec3Field& force) const {
  for_each_taut(position, [&](const Limited& spring, const Vec3& d, double length, double tension) {
    const Vec3 pull = tension / length * d;
    force.add(spring.first, pull), force.add(spring.second, -pull);
  });
}

void RateTensions::add_stiffness(const Vec3Field& position, Linearisation& matrix) const {
  const double square = weight_ * weight_;
  for_each_taut(position, [&](const Limited& spring, const Vec3& d, double length, double tension) {
    const double across = square * tension / length;
    matrix.springs.add(spring.spring, block_along(across, square * spring.penalty - across, d / length));
  });
}

void RateTensions::update(const Vec3Field& position) {
  for (std::size_t s = 0; s < springs_.size(); ++s)
    tension_[s] = tension_at(s, difference(springs_[s], position).norm());
}

double RateTensions::power(const Vec3Field& position, const Vec3Field& velocity) const {
  double power = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    if (!(tension_[s] > 0)) continue;
    const Vec3 d = difference(springs_[s], position);
    power -= tension_[s] * d.dot(difference(springs_[s], velocity)) / d.norm();
  }
  return power;
}

}  // namespace cloth
