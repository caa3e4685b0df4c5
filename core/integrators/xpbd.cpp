#include "integrators/xpbd.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "integrators/largest_square.h"

namespace cloth {
Xpbd::Visitor Xpbd::visitor_for(const ForceModel& forces, const NodeDamping& parts) {
  const ClothSystem& system = forces.system();
  has_others_ = !system.bending.empty() || !system.sliders.empty() || !system.membrane.empty();
  const bool by_grid = iterations_ == 1 && forces.sweep() && forces.sweep()->projects() &&
                       parts.stretch_time == 0 && !parts.normal && !has_others_;
  if (by_grid) return Visitor::grid;
  const bool has_negative_part = parts.along_normal.each < 0 || parts.along_normal.per_mass < 0;
  if (has_negative_part) return Visitor::one_by_one;  // less drag along the normal than across it
  if (!coloured_.describe(system)) coloured_ = ColouredSprings(system);
  if (!elements_.describe(system)) elements_ = ProjectedElements(system);
  return coloured_.are_visited_by_vectors() && elements_.suits_kernels() ? Visitor::colours
                                                                         : Visitor::one_by_one;
}

std::string Xpbd::visits_text(const ForceModel& forces) {
  const Visitor visitor = visitor_for(forces, forces.damping_parts());
  const std::string what = has_others_ ? "springs and other elements" : "springs";
  return what + (visitor == Visitor::grid      ? " by vectors, row by row"
                 : visitor == Visitor::colours ? " by vectors, colour by colour"
                                               : " one by one");
}

void Xpbd::begin_substeps(const ForceModel& forces, const NodeDamping& parts, double h) {
  const ClothSystem& system = forces.system();
  const std::size_t count = system.mass.size();
  for (auto* numbers : {&isotropic_, &kept_, &pushed_, &along_}) numbers->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_pinned = system.inverse_mass[i] == 0;
    double mass = system.mass[i] + h * parts.isotropic.of(system.mass[i]);
    if (parts.held_particle == static_cast<int>(i))
      mass += h * parts.held_isotropic + h * h * parts.held_stiffness;
    const double along = h * parts.along_normal.of(system.mass[i]);
    isotropic_[i] = is_pinned ? 0 : 1 / mass;
    kept_[i] = is_pinned ? 1 : system.mass[i] / mass;
    pushed_[i] = is_pinned ? 0 : h / mass;
    along_[i] = is_pinned ? 0 : along / (mass + along);
  }
  spring_damping_ = parts.along_springs, stretch_time_ = parts.stretch_time;
  bending_time_ = parts.bending_time, membrane_time_ = parts.membrane_time;
  sliders_ = parts.sliders;
  if (visitor_ == Visitor::grid) forces.sweep()->begin_projections(isotropic_);
  if (visitor_ != Visitor::colours) return;
  coloured_.begin(h, {parts.along_springs, parts.stretch_time}, isotropic_);
  if (has_others_) elements_.begin({parts.bending_time, parts.membrane_time}, isotropic_);
}

/// v* and b. Inverted after Sherman and Morrison (1950): n is of length one or zero.
void Xpbd::predict(const ForceModel& forces, const NodeDamping& parts, Vec3Field& velocity) {
  const Vec3Field& force = forces.position_force();
  const auto push = [&](double* v, const double* f) {
    for (std::size_t i = 0; i < kept_.size(); ++i) v[i] = kept_[i] * v[i] + pushed_[i] * f[i];
  };
  push(velocity.x(), force.x());
  push(velocity.y(), force.y());
  push(velocity.z(), force.z());
  if (!parts.normal) return;
  const double *nx = parts.normal->x(), *ny = parts.normal->y(), *nz = parts.normal->z();
  double *vx = velocity.x(), *vy = velocity.y(), *vz = velocity.z();
  for (std::size_t i = 0; i < along_.size(); ++i) {
    const double along = along_[i] * (nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i]);
    vx[i] -= along * nx[i], vy[i] -= along * ny[i], vz[i] -= along * nz[i];
  }
  if (visitor_ != Visitor::colours) return;
  if (drag_.size() != velocity.size()) drag_ = Vec3Field(velocity.size());
  double *bx = drag_.x(), *by = drag_.y(), *bz = drag_.z();
  for (std::size_t i = 0; i < along_.size(); ++i) {
    const double root = std::sqrt(isotropic_[i] * along_[i]);
    bx[i] = root * nx[i], by[i] = root * ny[i], bz[i] = root * nz[i];
  }
}

void Xpbd::note_mobilities(const NodeDamping& parts) {
  mobility_.assign(isotropic_.size(), {});
  for (std::size_t i = 0; i < mobility_.size(); ++i) {
    mobility_[i].isotropic = isotropic_[i];
    if (!parts.normal) continue;
    mobility_[i].normal = (*parts.normal)[i];
    mobility_[i].along_normal = isotropic_[i] * along_[i];
  }
}

double Xpbd::visit(const SpringRun& run, std::size_t i, const Vec3Field& start, double h, Vec3& impulse,
                   Vec3Field& velocity) const {
  const std::size_t j = i + static_cast<std::size_t>(run.offset);
  const Mobility &a = mobility_[i], &b = mobility_[j];
  const double mobility = a.isotropic + b.isotropic;
  if (mobility == 0) return 0;
  const auto speed_by = [&](const Vec3& given) -> Vec3 { return a.times(given) + b.times(given); };

  // The direction. A stretched spring pulls: without its impulse its ends lie further apart on the same line,
  // which is the direction it has after the visit. A compressed one takes the direction as it is.
  const Vec3 first = start[j] - start[i];
  const Vec3 speed = velocity[j] - velocity[i];
  const Vec3 between = first + h * speed;
  const bool pulls = impulse.dot(between) <= 0;
  const Vec3 line = pulls ? Vec3(between - h * mobility * impulse) : between;
  const double length = line.norm();
  if (!(length > 0)) return 0;
  const Vec3 d = line / length;

  // What of the impulse lies across. It goes; under compression at most as much at a time as turns the spring
  // by half its length, because there turning it moves the ends further across.
  Vec3 across = Vec3::Zero();
  if (!pulls) {
    const double reach = h * mobility * impulse.norm();
    const double removed = 2 * reach > length ? length / (2 * reach) : 1;
    across = (1 - removed) * (impulse - impulse.dot(d) * d);
  }

  // Along d, the speed after the visit is affine in lambda: rate + give * lambda.
  const double give = d.dot(speed_by(d));
  const double rate = d.dot(speed + speed_by(across - impulse));
  const double stretch = d.dot(first) + h * rate - run.rest_length;
  const double damping = spring_damping_ + stretch_time_ * run.stiffness;
  const double lambda = std::isinf(run.stiffness) ? -stretch / (h * give)
                                                  : -h * (run.stiffness * stretch + damping * rate) /
                                                        (1 + h * (h * run.stiffness + damping) * give);

  const Vec3 next = lambda * d + across;
  const Vec3 speed_i = a.times(next - impulse), speed_j = b.times(next - impulse);
  impulse = next;
  velocity.add(i, -speed_i);
  velocity.add(j, speed_j);
  return std::max(speed_i.squaredNorm(), speed_j.squaredNorm());
}

double Xpbd::visit_springs(const ClothSystem& system, const Vec3Field& start, double h, Vec3Field& velocity) {
  double largest = 0;
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t spring, std::size_t i, std::size_t) {
    if (run.stiffness > 0) largest = std::max(largest, visit(run, i, start, h, impulse_[spring], velocity));
  });
  return largest;
}

double Xpbd::visit_others(const ClothSystem& system, const Vec3Field& start, double h, Vec3Field& velocity) {
  double largest = 0;
  std::size_t element = system.springs.spring_count();
  for (const BendingRun& run : system.bending)
    for (int e = run.first; e < run.first + run.count; ++e, ++element)
      largest = std::max(largest, visit(run, e, start, h, impulse_[element], velocity));
  for (std::size_t k = 0; sliders_ && k < system.sliders.size(); ++k)
    largest = std::max(largest, visit(system.sliders[k], k, start, h, impulse_[element + k], velocity));
  element += system.sliders.size();
  for (const MembraneTriangle& t : system.membrane) {
    largest = std::max(largest, visit(t, start, h, impulse_.data() + element, velocity));
    element += 3;
  }
  return largest;
}

double Xpbd::pass(const ClothSystem& system, const Vec3Field& start, double h, bool measured,
                  Vec3Field& velocity) {
  if (visitor_ == Visitor::one_by_one)
    return std::max(visit_springs(system, start, h, velocity), visit_others(system, start, h, velocity));
  const double by_springs = coloured_.visit(measured);
  if (!has_others_) return by_springs;
  elements_.visit(coloured_.particles());
  return std::max(by_springs, coloured_.particles().largest_change);
}

/// The impulse P on kappa is linear in P where the slider does not yield: P = -h A K (kappa' - slip), kappa'
/// = kappa + h (u + G P) with u = dkappa/dt without P.
double Xpbd::visit(const BendingSlider& s, std::size_t number, const Vec3Field& start, double h,
                   Vec3& impulse, Vec3Field& velocity) const {
  const Vec3 n = sliders_->normal[number];
  double stretch = -sliders_->slip[number], give = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p) {
    const std::size_t i = at(s.particle[p]);
    const double c = s.coefficient[p];
    stretch += c * n.dot(start[i] + h * velocity[i]);
    give += c * c * n.dot(mobility_[i].times(n));
  }
  double& given = impulse.x();
  stretch -= h * give * given;
  const double weight = h * s.area * s.stiffness, most = h * s.area * s.yield;
  const double next = std::clamp(-weight * stretch / (1 + h * weight * give), -most, most);
  double largest = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p) {
    const std::size_t i = at(s.particle[p]);
    const Vec3 change = s.coefficient[p] * (next - given) * mobility_[i].times(n);
    velocity.add(i, change);
    largest = std::max(largest, change.squaredNorm());
  }
  given = next;
  return largest;
}

/// With J = dq/dx, G = J W J^T and the impulses J^T lambda: (I + h (h + t) K G) lambda = -h K a, a what q' +
/// t dq'/dt would be without them.
double Xpbd::visit(const MembraneTriangle& t, const Vec3Field& start, double h, Vec3* impulse,
                   Vec3Field& velocity) const {
  std::array<Vec3, 3> v, given, d;  // m/s, W P, edges in m
  for (std::size_t c = 0; c < 3; ++c) {
    v[c] = velocity[at(t.corner[c])];
    given[c] = mobility_[at(t.corner[c])].times(impulse[c]);
  }
  Eigen::Vector3d without;
  Eigen::Matrix3d k, give;
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t end = (e + 1) % 3;
    d[e] = edge_of(t, e, start) + h * (v[end] - v[e]);
    const double rate = 2 * d[e].dot(v[end] - v[e]), by_impulse = 2 * d[e].dot(given[end] - given[e]);
    without[static_cast<Eigen::Index>(e)] =
        d[e].squaredNorm() - t.rest_square[e] - h * by_impulse + membrane_time_ * (rate - by_impulse);
  }
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t f = 0; f < 3; ++f) {
      const auto push = [&](std::size_t corner) -> Vec3 {  // speed by the impulse of edge f
        const double sign = corner == f ? -2 : corner == (f + 1) % 3 ? 2 : 0;
        return mobility_[at(t.corner[corner])].times(sign * d[f]);
      };
      const auto i = static_cast<Eigen::Index>(e), j = static_cast<Eigen::Index>(f);
      k(i, j) = t.k[e][f];
      give(i, j) = 2 * d[e].dot(push((e + 1) % 3) - push(e));
    }
  const Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity() + h * (h + membrane_time_) * k * give;
  const Eigen::Vector3d lambda = matrix.partialPivLu().solve(Eigen::Vector3d(-h * (k * without)));
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t before = (c + 2) % 3;
    const Vec3 next = 2 * (lambda[static_cast<Eigen::Index>(before)] * d[before] -
                           lambda[static_cast<Eigen::Index>(c)] * d[c]);
    const Vec3 change = mobility_[at(t.corner[c])].times(next - impulse[c]);
    velocity.add(at(t.corner[c]), change);
    largest = std::max(largest, change.squaredNorm());
    impulse[c] = next;
  }
  return largest;
}

/// With s = sum c x at the start and u = sum c v without the element's impulse P, the latter is linear in P:
/// P = -k (h s + (h^2 + h t) (u + G P)), G = sum c^2 W.
double Xpbd::visit(const BendingRun& run, int first, const Vec3Field& start, double h, Vec3& impulse,
                   Vec3Field& velocity) const {
  Vec3 s = Vec3::Zero(), u = Vec3::Zero();
  Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
  const auto point = [&](std::size_t p) { return static_cast<std::size_t>(first + run.offset[p]); };
  for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p) {
    const double c = run.coefficient[p];
    s += c * start[point(p)];
    u += c * velocity[point(p)];
    give += c * c * mobility_[point(p)].matrix();
  }
  u -= give * impulse;
  const double weight = run.stiffness * h * (h + bending_time_);
  const Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity() + weight * give;
  const Vec3 next = -matrix.llt().solve(run.stiffness * h * s + weight * u);
  double largest = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p) {
    const Vec3 change = run.coefficient[p] * mobility_[point(p)].times(next - impulse);
    velocity.add(point(p), change);
    largest = std::max(largest, change.squaredNorm());
  }
  impulse = next;
  return largest;
}

std::size_t Xpbd::impulse_count(const ClothSystem& system) {
  std::size_t count = system.springs.spring_count();
  for (const BendingRun& run : system.bending) count += static_cast<std::size_t>(run.count);
  return count + system.sliders.size() + 3 * system.membrane.size();
}

double Xpbd::substep(const ForceModel& forces, const NodeDamping& parts, double h, bool measured,
                     const Vec3Field& position, Vec3Field& velocity) {
  predict(forces, parts, velocity);
  if (visitor_ == Visitor::grid) return forces.sweep()->project(h, parts.along_springs, position, velocity);
  if (visitor_ == Visitor::colours)
    coloured_.begin_substep(position, velocity, parts.normal ? &drag_ : nullptr, iterations_ > 1);
  if (visitor_ == Visitor::colours && has_others_) elements_.begin_step(parts.sliders);
  if (visitor_ == Visitor::one_by_one) {
    note_mobilities(parts);
    impulse_.assign(impulse_count(forces.system()), Vec3::Zero());
  }
  double changed = 0;
  for (int k = 0; k < iterations_; ++k)
    changed = pass(forces.system(), position, h, measured && k + 1 == iterations_, velocity);
  if (visitor_ == Visitor::colours) coloured_.give(velocity);
  return changed;
}

IntegratorReport Xpbd::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report;
  report.inner_steps = substeps_;
  const double h = times.step / substeps_;
  const NodeDamping parts = forces.damping_parts();
  visitor_ = visitor_for(forces, parts);
  begin_substeps(forces, parts, h);

  for (int n = 0; n < substeps_; ++n) {
    const double end = n + 1 == substeps_ ? times.end : times.begin + (n + 1) * h;
    forces.update_external(state.position, end);
    ++report.force_evaluations;
    if (contact_) contact_->begin(state);
    if (constraint_) {
      // As forces, tensions would act where their springs were. A substep is long for that: it would make
      // energy.
      constraint_->forget_tensions();
      constraint_->before_kick(h, h, state);
    }
    const double changed = substep(forces, parts, h, n + 1 == substeps_, state.position, state.velocity);
    report.iterations += iterations_;
    if (n + 1 == substeps_) {
      const double fastest = largest_square(state.velocity);
      report.residual = fastest > 0 ? std::sqrt(changed / fastest) : 0;
    }

    add_scaled(h, state.velocity, state.position);
    if (constraint_) constraint_->after_drift(0, state);
    if (contact_ && contact_->correct({end - h, end, h}, state) == InnerStepContact::Outcome::ended) break;
    if (forces.has_power()) {
      forces.update(state.position, end);
      ++report.force_evaluations;
      end_power_ = forces.power(state.position, state.velocity);
      end_weight_ = h;
      work += end_weight_ * end_power_;
    }
  }
  return report;
}

}  // namespace cloth
