// The damping centred in time: (m + weight D) v = m known + weight p. Where D couples no particles (viscous
// damping, air) every particle has a 3x3 system with a closed solution; spring damping couples them and takes
// a few steps of conjugate gradients, preconditioned by the closed solution of the rest.
#include "cloth/sums.h"
#include "forces/force_model.h"

namespace cloth {
namespace {

/// Relative to the right-hand side; far below any method's error, so that the order of the step is not
/// touched.
constexpr double tolerance = 1e-13;
constexpr int max_iterations = 200;

double dot(const Vec3Field& a, const Vec3Field& b) {
  return cloth::dot(a.flat(), b.flat());
}

void add_scaled(Vec3Field& to, double scale, const Vec3Field& from) {
  const auto a = to.flat();
  const auto b = from.flat();
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += scale * b[k];
}

void clear_pinned(const ClothSystem& system, Vec3Field& field) {
  for (std::size_t i = 0; i < field.size(); ++i)
    if (system.pinned[i]) field.set(i, Vec3::Zero());
}

/// visit(k, mass of the particle that component k of a field belongs to)
template <class Visit>
void for_each_component(const ClothSystem& system, Visit visit) {
  const double* mass = system.mass.data();
  const std::size_t size = system.mass.size();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < size; ++i) visit(axis * size + i, mass[i]);
}

}  // namespace

int ForceModel::centred_velocity(double weight, const Vec3Field& known, Vec3Field& velocity) {
  if (rhs_.size() != known.size()) rhs_ = Vec3Field(known.size());
  const auto rhs = rhs_.flat();
  const auto v = known.flat();
  const auto p = position_force_.flat();
  for_each_component(*system_, [&](std::size_t k, double mass) { rhs[k] = mass * v[k] + weight * p[k]; });
  clear_pinned(*system_, rhs_);

  NodeDamping damping;
  bool local = true;
  for (const auto& force : forces_) local = force->add_node_damping(damping) && local;
  if (pull_) pull_->add_node_damping(damping);
  if (!local) return solve_coupled(weight, rhs_, velocity);
  solve_per_node(weight, damping, rhs_, velocity);
  return 0;
}

/// ((m + w a) I + w b n n^T) v = r, inverted after Sherman and Morrison (1950): n is of length one or zero.
void ForceModel::solve_per_node(double weight, const NodeDamping& damping, const Vec3Field& rhs,
                                Vec3Field& velocity) const {
  const double isotropic = weight * damping.isotropic;
  const auto r = rhs.flat();
  const auto v = velocity.flat();
  for_each_component(*system_, [&](std::size_t k, double mass) { v[k] = r[k] / (mass + isotropic); });

  if (damping.normal) {
    const double along = weight * damping.along_normal;
    const double* mass = system_->mass.data();
    const double *nx = damping.normal->x(), *ny = damping.normal->y(), *nz = damping.normal->z();
    double *vx = velocity.x(), *vy = velocity.y(), *vz = velocity.z();
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      const double scale = along / (mass[i] + isotropic + along);
      const double correction = scale * (nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i]);
      vx[i] -= correction * nx[i], vy[i] -= correction * ny[i], vz[i] -= correction * nz[i];
    }
  }
  if (damping.held_particle >= 0) {
    const auto held = static_cast<std::size_t>(damping.held_particle);
    const Vec3 n = damping.normal ? (*damping.normal)[held] : Vec3::Zero();
    const double held_diagonal = system_->mass[held] + isotropic + weight * damping.held_isotropic;
    const double along = weight * damping.along_normal;
    const Vec3 r_held = rhs[held];
    velocity.set(held, (r_held - along / (held_diagonal + along) * n.dot(r_held) * n) / held_diagonal);
  }
}

int ForceModel::solve_coupled(double weight, const Vec3Field& rhs, Vec3Field& velocity) {
  if (residual_.size() != rhs.size()) residual_ = direction_ = product_ = Vec3Field(rhs.size());
  NodeDamping local;
  for (const auto& force : forces_) force->add_node_damping(local);
  if (pull_) pull_->add_node_damping(local);

  const auto multiply = [&](const Vec3Field& v, Vec3Field& result) {
    damping_product(v, result);
    const auto out = result.flat();
    const auto in = v.flat();
    for_each_component(*system_,
                       [&](std::size_t k, double mass) { out[k] = mass * in[k] + weight * out[k]; });
    clear_pinned(*system_, result);
  };

  clear_pinned(*system_, velocity);
  multiply(velocity, product_);
  residual_ = rhs;
  add_scaled(residual_, -1, product_);
  const double goal = tolerance * tolerance * dot(rhs, rhs);
  Vec3Field& preconditioned = product_;  // shares storage: never needed at the same time as A p
  solve_per_node(weight, local, residual_, preconditioned);
  direction_ = preconditioned;
  double slope = dot(residual_, preconditioned);

  int iterations = 0;
  while (iterations < max_iterations && dot(residual_, residual_) > goal) {
    multiply(direction_, product_);
    const double curvature = dot(direction_, product_);
    if (!(curvature > 0)) break;
    const double length = slope / curvature;
    add_scaled(velocity, length, direction_);
    add_scaled(residual_, -length, product_);
    solve_per_node(weight, local, residual_, preconditioned);
    const double next_slope = dot(residual_, preconditioned);
    const double keep = next_slope / slope;
    slope = next_slope;
    const auto d = direction_.flat();
    const auto q = preconditioned.flat();
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = q[k] + keep * d[k];
    ++iterations;
  }
  return iterations;
}

}  // namespace cloth
