#include "support/states.h"

#include <cmath>
#include <numbers>

#include "cloth/grid.h"

namespace cloth::test {

ClothState crumpled_state(const ClothSystem& system, double deviation, double speed, Random& random) {
  ClothState state = starting_state(system);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3 shift = random.vector(deviation), velocity = random.vector(speed);
    if (system.pinned[i]) continue;
    state.position.add(i, shift);
    state.velocity.set(i, velocity);
  }
  return state;
}

ClothState waving_state(const ClothSystem& system, double strain, double speed) {
  constexpr double pi = std::numbers::pi;
  ClothState state = starting_state(system);
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < state.position.size(); ++i) centre += system.start[i];
  centre /= static_cast<double>(system.size());
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const double u = double(static_cast<int>(i) % system.columns) / (system.columns - 1);
    const double v = double(static_cast<int>(i) / system.columns) / (system.rows - 1);
    const Vec3 arm = system.start[i] - centre;
    state.position.set(i, centre + (1 + strain) * arm);
    state.velocity.set(
        i, speed * Vec3(0.3 + std::cos(pi * v), 0.2 - std::cos(pi * u), std::cos(pi * u) * std::cos(pi * v)) +
               Vec3(0.1, 0.2, 0.5).cross(arm));
  }
  return state;
}

Vec3 momentum(const ClothSystem& system, const ClothState& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < state.velocity.size(); ++i) sum += system.mass[i] * state.velocity[i];
  return sum;
}

Vec3 angular_momentum(const ClothSystem& system, const ClothState& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    sum += system.mass[i] * state.position[i].cross(state.velocity[i]);
  return sum;
}

double rms_distance(const Vec3Field& a, const Vec3Field& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double largest_distance(const Vec3Field& a, const Vec3Field& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

double largest_norm(const Vec3Field& field) {
  double largest = 0;
  for (std::size_t i = 0; i < field.size(); ++i) largest = std::max(largest, field[i].norm());
  return largest;
}

bool all_finite(const Vec3Field& field) {
  for (const double value : field.flat())
    if (!std::isfinite(value)) return false;
  return true;
}

bool all_finite(const ClothState& state) {
  return all_finite(state.position) && all_finite(state.velocity);
}

}  // namespace cloth::test
