#include "integrators/vbd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/at.h"
#include "integrators/largest_square.h"
#include "kernels/grid_descent.h"
#include "kernels/grid_layout.h"
#include "kernels/mesh_descent.h"

namespace cloth {
/// By Cholesky; where rounding has left no positive pivot, a step that is short enough whatever the matrix.
Vec3 Vbd::Local::solution() const {
  const double a = block.xx, b = block.xy / a, c = block.xz / a;
  const double d = block.yy - b * block.xy, e = (block.yz - b * block.xz) / d;
  const double f = block.zz - c * block.xz - e * e * d;
  if (a <= 0 || d <= 0 || f <= 0) return push / (block.xx + block.yy + block.zz);
  const double y = push.y() - b * push.x(), z = push.z() - c * push.x() - e * y;
  const double vz = z / f, vy = y / d - e * vz;
  return {push.x() / a - b * vy - c * vz, vy, vz};
}

double ChebyshevWeights::next(double squares) {
  constexpr double noticeable = 1.02, smaller = 0.9;
  constexpr int settled = 3;  // iterations after which moves fall as they will go on to
  const double before = std::exchange(move_, std::sqrt(squares));
  if (++since_ < settled || !(before > 0)) return weight_;
  const double fall = move_ / before;
  if (fall > 1 && weight_ > 1) {
    radius_ *= smaller, since_ = 0;
    return weight_ = 1;
  }
  if (fall > noticeable * std::sqrt(weight_ - 1)) {
    const double found = (fall + (weight_ - 1) / fall) / weight_;
    if (found > radius_ && radius_ < largest_radius) radius_ = std::min(found, largest_radius), since_ = 0;
  }
  return weight_ = 2 / (1 + std::sqrt(1 - radius_ * radius_));
}

/// W^-1 and v*, with the external forces at `reference`; the hand's spring is followed from there.
void Vbd::predict(const ForceModel& forces, const Vec3Field& reference, Visits& visits) {
  visits.parts = forces.damping_parts();
  const NodeDamping& parts = visits.parts;
  const double h = visits.step;
  const Vec3Field& force = forces.position_force();
  for (std::size_t i = 0; i < inertia_.size(); ++i) {
    if (visits.system.inverse_mass[i] == 0) continue;
    const double mass = visits.system.mass[i];
    Inertia& inertia = inertia_[i];
    inertia = {.mass = mass + h * parts.isotropic.of(mass)};
    Vec3 impulse = mass * start_velocity_[i] + h * force[i];
    if (parts.held_particle == static_cast<int>(i)) {
      inertia.mass += h * parts.held_isotropic + h * h * parts.held_stiffness;
      impulse += h * parts.held_stiffness * (reference[i] - start_position_[i]);
    }
    if (parts.normal) inertia.along = h * parts.along_normal.of(mass), inertia.normal = (*parts.normal)[i];
    const double share = inertia.along / (inertia.mass + inertia.along * inertia.normal.squaredNorm());
    predicted_.set(i, (impulse - share * inertia.normal.dot(impulse) * inertia.normal) / inertia.mass);
  }
}

void Vbd::add_springs(const Visits& visits, std::size_t i, Local& local) const {
  const Vec3Field &x = visits.state.position, &v = visits.state.velocity;
  const double h = visits.step;
  const Vec3 here = x[i], speed = v[i];
  for (const SpringEnd& spring : elements_.springs(i)) {
    const Vec3 between = x[at(spring.other)] - here;
    const double length = between.norm(),
                 damping = visits.parts.along_springs + visits.parts.stretch_time * spring.stiffness;
    const double along = h * (h * spring.stiffness + damping);
    local.reach = std::max(local.reach, length + spring.rest_length);
    if (length == 0) {
      local.add_isotropic(along);
      continue;
    }
    const Vec3 n = between / length;
    const double tension =
        spring.stiffness * (length - spring.rest_length) + damping * n.dot(v[at(spring.other)] - speed);
    local.push += h * tension * n;
    const double across = std::max(h * h * tension / length, 0.0);
    local.add_isotropic(across);
    local.add_along(along - across, n);
  }
}

/// The energy is quadratic: push/own is how far bending alone would move the particle.
void Vbd::add_bending(const Visits& visits, std::size_t i, Local& local) const {
  const double h = visits.step, time = visits.parts.bending_time;
  const Vec3Field &x = visits.state.position, &v = visits.state.velocity;
  const Vec3 here = x[i], speed = v[i];
  Vec3 pull = Vec3::Zero();
  double own = 0;
  for (const BendingEntry& entry : elements_.bending(i)) {
    const std::size_t j = at(entry.other);
    pull -= entry.stiffness * (x[j] - here + time * (v[j] - speed));
    own -= entry.stiffness;
  }
  if (!(own > 0)) return;
  local.push += h * pull;
  local.add_isotropic(h * (h + time) * own);
  local.reach = std::max(local.reach, pull.norm() / own);
}

/// With the stiffness of a slider that does not yield, which is never too little.
void Vbd::add_sliders(const Visits& visits, std::size_t i, Local& local) const {
  if (!visits.parts.sliders) return;
  const SliderState& sliders = *visits.parts.sliders;
  const double h = visits.step;
  for (const ElementPoint& point : elements_.sliders(i)) {
    const BendingSlider& s = visits.system.sliders[at(point.element)];
    const double c = s.coefficient[at(point.point)];
    if (c == 0) continue;
    const Vec3 n = sliders.normal[at(point.element)];
    double stretch = -sliders.slip[at(point.element)];
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      stretch += s.coefficient[p] * n.dot(visits.state.position[at(s.particle[p])]);
    const double moment = std::clamp(s.stiffness * stretch, -s.yield, s.yield);
    local.push -= h * s.area * moment * c * n;
    local.add_along(h * h * s.area * s.stiffness * c * c, n);
    local.reach = std::max(local.reach, std::abs(stretch / c));
  }
}

/// Corner c is the beginning of edge c and the end of the edge before: of q, dq/dx is -2 d and 2 d.
void Vbd::add_triangles(const Visits& visits, std::size_t i, Local& local) const {
  const double h = visits.step, time = visits.parts.membrane_time;
  for (const ElementPoint& point : elements_.triangles(i)) {
    const MembraneTriangle& t = visits.system.membrane[at(point.element)];
    std::array<Vec3, 3> d;
    std::array<double, 3> q;
    for (std::size_t e = 0; e < 3; ++e) {
      d[e] = edge_of(t, e, visits.state.position);
      q[e] =
          d[e].squaredNorm() - t.rest_square[e] + time * 2 * d[e].dot(edge_of(t, e, visits.state.velocity));
    }
    const std::array<double, 3> tension = times_k(t, q);
    const std::size_t out = at(point.point), in = (out + 2) % 3;
    const Vec3 by_out = -2 * d[out], by_in = 2 * d[in];
    local.push -= h * (tension[out] * by_out + tension[in] * by_in);
    // k a a^T + l b b^T + m (a b^T + b a^T), by its halves (a + b) and (a - b)
    const double weight = h * (h + time), mixed = 0.5 * weight * t.k[out][in];
    local.add_along(weight * t.k[out][out], by_out);
    local.add_along(weight * t.k[in][in], by_in);
    local.add_along(mixed, by_out + by_in);
    local.add_along(-mixed, by_out - by_in);
    local.add_isotropic(2 * h * h * (std::max(tension[out], 0.0) + std::max(tension[in], 0.0)));
    for (const std::size_t e : {out, in})
      local.reach = std::max(local.reach, d[e].norm() + std::sqrt(t.rest_square[e]));
  }
}

Vec3 Vbd::change_of(const Visits& visits, std::size_t i) const {
  const Inertia& inertia = inertia_[i];
  const Vec3 n = inertia.normal, beyond = visits.state.velocity[i] - predicted_[i];
  Local local{.push = -inertia.mass * beyond - inertia.along * n.dot(beyond) * n,
              .block = block_along(inertia.mass, inertia.along, n),
              .reach = visits.step * beyond.norm()};
  add_springs(visits, i, local);
  add_bending(visits, i, local);
  add_sliders(visits, i, local);
  add_triangles(visits, i, local);
  const Vec3 change = local.solution();
  const double distance = visits.step * change.norm();
  return distance > local.reach ? Vec3(local.reach / distance * change) : change;
}

Vbd::Sweep Vbd::sweep(Visits& visits) {
  Sweep result;
  for (const std::vector<int>& colour : elements_.colours())
    for (const int particle : colour) {
      const std::size_t i = at(particle);
      if (inertia_[i].mass == 0) continue;
      const Vec3 change = change_of(visits, i);
      if (!change.allFinite()) {
        if (result.failed < 0) result.failed = particle;
        continue;
      }
      const Vec3 velocity = visits.state.velocity[i] + change;
      visits.state.velocity.set(i, velocity);
      visits.state.position.set(i, start_position_[i] + visits.step * velocity);
      result.change = std::max(result.change, change.squaredNorm());
      result.squares += change.squaredNorm();
    }
  return result;
}

void Vbd::extrapolate(double weight, Visits& visits) {
  if (weight > 1) {
    const auto to = visits.state.velocity.flat();
    const auto from = before_.flat();
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + weight * (to[k] - from[k]);
    visits.state.position = start_position_;
    add_scaled(visits.step, visits.state.velocity, visits.state.position);
  }
}

template <class SweepOnce, class Extrapolate>
Vbd::Sweep Vbd::iterate(const SweepOnce& sweep, const Extrapolate& extrapolate) const {
  ChebyshevWeights weights;
  Sweep last;
  for (int k = 0; k < iterations_ && last.failed < 0; ++k) {
    last = sweep(k);
    if (!accelerated_ || k + 1 == iterations_) continue;
    extrapolate(weights.next(last.squares));
  }
  return last;
}

void Vbd::predict_again(ForceModel& forces, double end, Visits& visits, int& evaluations) {
  forces.update_external(visits.state.position, end);
  predict(forces, visits.state.position, visits);
  ++evaluations;
}

bool Vbd::suits_kernels(const NodeDamping& parts) const {
  if (!descent_ || (parts.stretch_time > 0 && !descent_->takes_elements())) return false;
  return parts.along_normal.each >= 0 && parts.along_normal.per_mass >= 0;  // else no real b
}

std::string Vbd::visits_text(const ForceModel& forces) {
  prepare(forces.system());
  return suits_kernels(forces.damping_parts()) ? "particles by vectors, colour by colour"
                                               : "particles one by one, colour by colour";
}

/// The kernels' H^-1 is made of cofactors, which lose what is too small beside the stiffness.
bool Vbd::is_visited_by_kernels(const Visits& visits) const {
  constexpr double largest_ratio = 1e10;
  const NodeDamping& parts = visits.parts;
  if (!suits_kernels(parts)) return false;
  double lightest = std::numeric_limits<double>::infinity();
  for (const Inertia& inertia : inertia_)
    if (inertia.mass > 0) lightest = std::min(lightest, inertia.mass);
  const double h = visits.step;
  const double stiffest =
      std::max({h * ((h + parts.stretch_time) * stiffest_.spring + parts.along_springs),
                h * (h + parts.bending_time) * stiffest_.bending,
                h * (h + parts.membrane_time) * stiffest_.edge, h * h * stiffest_.slider});
  return stiffest < largest_ratio * lightest;
}

void Vbd::set_drag() {
  if (drag_.size() != inertia_.size()) drag_ = Vec3Field(inertia_.size());
  for (std::size_t i = 0; i < inertia_.size(); ++i)
    drag_.set(i, std::sqrt(inertia_[i].along) * inertia_[i].normal);
  descent_->set_drag(drag_, predicted_);
}

Vbd::Sweep Vbd::descend_by_kernels(ForceModel& forces, double end, Visits& visits, int& evaluations) {
  mass_.resize(inertia_.size());
  for (std::size_t i = 0; i < mass_.size(); ++i) mass_[i] = inertia_[i].mass;
  const bool has_drag = visits.parts.normal != nullptr;
  descent_->begin({.step = visits.step,
                   .mass = mass_,
                   .spring_damping = visits.parts.along_springs,
                   .stretch_time = visits.parts.stretch_time,
                   .bending_time = visits.parts.bending_time,
                   .membrane_time = visits.parts.membrane_time,
                   .sliders = visits.parts.sliders,
                   .position = start_position_,
                   .predicted = predicted_,
                   .extrapolates = accelerated_,
                   .has_drag = has_drag});
  const auto sweep_once = [&](int k) {
    if (has_drag) {
      if (k > 0) {
        descent_->read_positions(visits.state.position);
        predict_again(forces, end, visits, evaluations);
      }
      set_drag();
    }
    const ParticleDescent::Sums sums = descent_->sweep();
    return Sweep{.change = sums.change, .squares = sums.squares};
  };
  Sweep last = iterate(sweep_once, [&](double weight) { descent_->extrapolate(weight); });
  descent_->end(visits.state.velocity);
  for (std::size_t i = 0; i < mass_.size() && last.failed < 0; ++i)
    if (!visits.state.velocity[i].allFinite()) last.failed = static_cast<int>(i);
  visits.state.position = start_position_;
  add_scaled(visits.step, visits.state.velocity, visits.state.position);
  return last;
}

Vbd::Sweep Vbd::descend(ForceModel& forces, double end, Visits& visits, int& evaluations) {
  elements_.list();
  ClothState& state = visits.state;
  state.velocity = before_ = predicted_;
  add_scaled(visits.step, state.velocity, state.position);
  const auto sweep_once = [&](int k) {
    if (k > 0 && visits.parts.normal) predict_again(forces, end, visits, evaluations);
    if (accelerated_) present_ = state.velocity;
    return sweep(visits);
  };
  return iterate(sweep_once, [&](double weight) {
    extrapolate(weight, visits);
    std::swap(before_, present_);
  });
}

/// Precondition: `elements` are listed, or there is no bending.
Vbd::Stiffest Vbd::stiffest_of(const ClothSystem& system, const ParticleElements& elements) {
  Stiffest most;
  for (const SpringBlock& block : system.springs.blocks())
    most.spring = std::max(most.spring, block.run.stiffness);
  for (std::size_t i = 0; i < system.mass.size() && !system.bending.empty(); ++i) {
    double own = 0;
    for (const BendingEntry& entry : elements.bending(i)) own -= entry.stiffness;
    most.bending = std::max(most.bending, own);
  }
  most.edge = stiffest_edge(system.membrane);
  for (const BendingSlider& s : system.sliders)
    for (const double c : s.coefficient) most.slider = std::max(most.slider, s.area * s.stiffness * c * c);
  return most;
}

void Vbd::prepare(const ClothSystem& system) {
  if (elements_.describe(system)) return;
  elements_ = ParticleElements(system);
  descent_.reset();
  const bool has_springs_alone = system.bending.empty() && system.sliders.empty() && system.membrane.empty();
  const auto grid = has_springs_alone ? grid_springs(system) : std::nullopt;
  if (grid && GridDescent::suits(*grid)) {
    descent_ = std::make_unique<GridDescent>(*grid);
  } else if (!grid && MeshDescent::suits(system.springs)) {
    elements_.list();
    descent_ = std::make_unique<MeshDescent>(system, elements_);
  }
  if (descent_) stiffest_ = stiffest_of(system, elements_);
}

IntegratorReport Vbd::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report{.force_evaluations = 1, .iterations = iterations_};
  const double h = times.step;
  prepare(forces.system());
  inertia_.assign(state.position.size(), {});
  start_position_ = state.position, start_velocity_ = predicted_ = state.velocity;

  Visits visits{.system = forces.system(), .parts = {}, .step = h, .state = state};
  forces.update_external(state.position, times.end);
  predict(forces, state.position, visits);
  const Sweep last = is_visited_by_kernels(visits)
                         ? descend_by_kernels(forces, times.end, visits, report.force_evaluations)
                         : descend(forces, times.end, visits, report.force_evaluations);
  if (last.failed >= 0)
    report.failure = SolverFailure{last.failed, "the equation of a single particle has no finite solution"};
  const double fastest = largest_square(state.velocity);
  report.residual = fastest > 0 ? std::sqrt(last.change / fastest) : 0;
  left_.note(start_velocity_, state);
  if (forces.has_power()) {
    forces.update(state.position, times.end);
    ++report.force_evaluations;
    end_power_ = forces.power(state.position, state.velocity);
    end_weight_ = h;
    work += end_weight_ * end_power_;
  }
  return report;
}

}  // namespace cloth
