#include "integrators/xpbd.h"

#include <cmath>

namespace cloth {

/// Inverted after Sherman and Morrison (1950): n is of length one or zero.
void Xpbd::predict(const ClothSystem& system, const ForceModel& forces, const NodeDamping& parts, double h,
                   ClothState& state) {
  const Vec3Field& force = forces.position_force();
  const double along = h * parts.along_normal;
  for (std::size_t i = 0; i < mobility_.size(); ++i) {
    mobility_[i] = {};
    if (system.inverse_mass[i] == 0) continue;
    double mass = system.mass[i] + h * parts.isotropic;
    if (parts.held_particle == static_cast<int>(i))
      mass += h * parts.held_isotropic + h * h * parts.held_stiffness;
    Mobility& mobility = mobility_[i];
    mobility.isotropic = 1 / mass;
    if (parts.normal && along > 0) {
      mobility.normal = (*parts.normal)[i];
      mobility.along_normal = along / (mass * (mass + along));
    }
    const Vec3 momentum = system.mass[i] * state.velocity[i] + h * force[i];
    state.position.add(i, h * mobility.times(momentum));
  }
}

double Xpbd::visit(const SpringRun& run, std::size_t i, std::size_t spring, double spring_damping, double h,
                   Vec3Field& position) {
  const std::size_t j = i + static_cast<std::size_t>(run.offset);
  const Mobility &a = mobility_[i], &b = mobility_[j];
  const double mobility = a.isotropic + b.isotropic;
  if (mobility == 0) return 0;
  const auto moved_by = [&](const Vec3& impulse) -> Vec3 { return a.times(impulse) + b.times(impulse); };
  Vec3& impulse = impulse_[spring];

  // The direction. A stretched spring pulls: without its impulse its ends lie further apart on the same line,
  // which is the direction it has after the visit. A compressed one takes the direction as it is.
  const Vec3 between = position[j] - position[i];
  const bool pulls = impulse.dot(between) <= 0;
  const Vec3 line = pulls ? Vec3(between - mobility * impulse) : between;
  const double length = line.norm();
  if (!(length > 0)) return 0;
  const Vec3 d = line / length;

  // What of the impulse lies across. It goes; under compression at most as much at a time as turns the spring
  // by half its length, because there turning it moves the ends further across.
  Vec3 across = Vec3::Zero();
  if (!pulls) {
    const double reach = mobility * impulse.norm();
    const double removed = 2 * reach > length ? length / (2 * reach) : 1;
    across = (1 - removed) * (impulse - impulse.dot(d) * d);
  }

  // |x_j - x_i| and the change since the start are affine in lambda: base + give * lambda
  const double give = d.dot(moved_by(d));
  const double base = d.dot(between + moved_by(across - impulse));
  const double stretch = base - run.rest_length;
  double lambda;
  if (std::isinf(run.stiffness)) {
    lambda = -stretch / give;
  } else {
    const double stiffness = h * h * run.stiffness, damping = h * spring_damping;
    const double change = base - d.dot(start_[j] - start_[i]);
    lambda = -(stiffness * stretch + damping * change) / (1 + (stiffness + damping) * give);
  }

  const Vec3 next = lambda * d + across;
  const Vec3 difference = next - impulse;
  impulse = next;
  const Vec3 move_i = a.times(difference), move_j = b.times(difference);
  position.add(i, -move_i);
  position.add(j, move_j);
  return std::max(move_i.squaredNorm(), move_j.squaredNorm());
}

double Xpbd::pass(const ClothSystem& system, double spring_damping, double h, Vec3Field& position) {
  double largest = 0;
  std::size_t spring = 0;
  for (const SpringRun& run : system.springs) {
    for (int s = 0; s < run.count; ++s, ++spring)
      if (run.stiffness > 0)
        largest = std::max(largest, visit(run, static_cast<std::size_t>(run.first + s), spring,
                                          spring_damping, h, position));
  }
  return largest;
}

IntegratorReport Xpbd::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                            ClothState& state, Work& work) {
  IntegratorReport report;
  report.inner_steps = substeps_;
  const double h = times.step / substeps_;
  std::size_t springs = 0;
  for (const SpringRun& run : system.springs) springs += static_cast<std::size_t>(run.count);
  mobility_.resize(state.position.size());

  for (int n = 0; n < substeps_; ++n) {
    const double end = n + 1 == substeps_ ? times.end : times.begin + (n + 1) * h;
    start_ = state.position;
    forces.update_external(state.position, end);
    ++report.force_evaluations;
    const NodeDamping parts = forces.damping_parts();
    predict(system, forces, parts, h, state);

    impulse_.assign(springs, Vec3::Zero());
    double moved = 0;
    for (int k = 0; k < iterations_; ++k) moved = pass(system, parts.along_springs, h, state.position);
    report.iterations += iterations_;

    double fastest = 0;
    for (std::size_t i = 0; i < mobility_.size(); ++i) {
      if (system.inverse_mass[i] == 0) continue;
      state.velocity.set(i, (state.position[i] - start_[i]) / h);
      fastest = std::max(fastest, state.velocity[i].squaredNorm());
    }
    report.residual = fastest > 0 ? std::sqrt(moved / fastest) / h : 0;
    if (forces.has_power()) {
      forces.update(state.position, end);
      ++report.force_evaluations;
      work += h * forces.power(state.velocity);
    }
  }
  return report;
}

}  // namespace cloth
