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

/// visit(first) for the first component of each axis in a flat field.
template <class Visit>
void for_each_axis(std::size_t particles, Visit visit) {
  for (std::size_t axis = 0; axis < 3; ++axis) visit(axis * particles);
}

/// result = m in + weight result, 0 where pinned
void add_inertia(const ClothSystem& system, double weight, const Vec3Field& in, Vec3Field& result) {
  const std::size_t size = system.mass.size();
  for_each_axis(size, [&](std::size_t first) {
    const double *m = system.mass.data(), *inverse = system.inverse_mass.data(),
                 *v = in.flat().data() + first;
    double* out = result.flat().data() + first;
    for (std::size_t i = 0; i < size; ++i) out[i] = inverse[i] == 0 ? 0.0 : m[i] * v[i] + weight * out[i];
  });
}

/// result = factor r, where every particle has its factor
void scale_each(const std::vector<double>& factors, const Vec3Field& r, Vec3Field& result) {
  for_each_axis(factors.size(), [&](std::size_t first) {
    const double *factor = factors.data(), *from = r.flat().data() + first;
    double* out = result.flat().data() + first;
    for (std::size_t i = 0; i < factors.size(); ++i) out[i] = factor[i] * from[i];
  });
}

/// v += length d, r -= length q
void advance(double length, const Vec3Field& direction, const Vec3Field& product, Vec3Field& velocity,
             Vec3Field& residual) {
  const double *d = direction.flat().data(), *q = product.flat().data();
  double *v = velocity.flat().data(), *r = residual.flat().data();
  const std::size_t size = velocity.flat().size();
  for (std::size_t k = 0; k < size; ++k) v[k] += length * d[k];
  for (std::size_t k = 0; k < size; ++k) r[k] -= length * q[k];
}

/// direction = z + keep direction
void turn(double keep, const Vec3Field& z, Vec3Field& direction) {
  const double* from = z.flat().data();
  double* d = direction.flat().data();
  const std::size_t size = direction.flat().size();
  for (std::size_t k = 0; k < size; ++k) d[k] = from[k] + keep * d[k];
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
  const bool is_diagonal = !local.normal && local.held_particle < 0;
  inverse_diagonal_.resize(rhs.size());
  for (std::size_t i = 0; i < rhs.size(); ++i)
    inverse_diagonal_[i] = 1 / (system_->mass[i] + weight * local.isotropic);

  const auto multiply = [&](const Vec3Field& v, Vec3Field& result) {
    damping_product(v, result);
    add_inertia(*system_, weight, v, result);
  };
  Vec3Field& preconditioned = product_;  // shares storage: never needed at the same time as A d
  const auto precondition = [&] {
    if (is_diagonal)
      scale_each(inverse_diagonal_, residual_, preconditioned);
    else
      solve_per_node(weight, local, residual_, preconditioned);
    return dot(residual_, preconditioned);
  };

  clear_pinned(*system_, velocity);
  residual_ = rhs;
  precondition();
  const double goal = tolerance * tolerance * dot(rhs, preconditioned);
  multiply(velocity, product_);
  for (std::size_t k = 0; k < rhs.flat().size(); ++k) residual_.flat()[k] -= product_.flat()[k];
  double slope = precondition();
  direction_ = preconditioned;

  int iterations = 0;
  while (iterations < max_iterations && slope > goal) {
    multiply(direction_, product_);
    const double curvature = dot(direction_, product_);
    if (!(curvature > 0)) break;
    advance(slope / curvature, direction_, product_, velocity, residual_);
    const double next_slope = precondition();
    turn(next_slope / slope, preconditioned, direction_);
    slope = next_slope;
    ++iterations;
  }
  return iterations;
}

}  // namespace cloth
