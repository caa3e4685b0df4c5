// The damping centred in time: (m + weight D) v = m known + weight p. Where D couples no particles (viscous
// damping, air) every particle has a 3x3 system with a closed solution; spring damping couples them and takes
// a few steps of conjugate gradients, preconditioned by the closed solution of the rest. What is done between
// two products with D goes through the particles in strips that stay in the nearest cache.
#include <algorithm>

#include "cloth/sums.h"
#include "forces/force_model.h"
#include "forces/node_matrix.h"

namespace cloth {
namespace {

/// Relative to the right-hand side; far below any method's error, so that the order of the step is not
/// touched.
constexpr double tolerance = 1e-13;
constexpr int max_iterations = 1000;

/// m v + weight p
void right_hand_side(const double* mass, double weight, const Strip<const double>& v,
                     const Strip<const double>& p, const Strip<double>& result) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double *known = v.axis[axis], *force = p.axis[axis];
    double* to = result.axis[axis];
    for (std::size_t i = 0; i < result.count; ++i) to[i] = mass[i] * known[i] + weight * force[i];
  }
}

/// v += weight f/m
void accelerate(double weight, const double* inverse_mass, const Strip<const double>& force,
                const Strip<double>& v) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* f = force.axis[axis];
    double* to = v.axis[axis];
    for (std::size_t i = 0; i < v.count; ++i) to[i] += weight * inverse_mass[i] * f[i];
  }
}

/// direction = z + keep direction
void turn(double keep, const Strip<const double>& z, const Strip<double>& direction) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* from = z.axis[axis];
    double* d = direction.axis[axis];
    for (std::size_t i = 0; i < z.count; ++i) d[i] = from[i] + keep * d[i];
  }
}

/// v += length d
void advance(double length, const Strip<const double>& d, const Strip<double>& v) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* from = d.axis[axis];
    double* to = v.axis[axis];
    for (std::size_t i = 0; i < v.count; ++i) to[i] += length * from[i];
  }
}

}  // namespace

int ForceModel::centred_velocity(double weight, const Vec3Field& position, Vec3Field& velocity,
                                 Vec3Field& force) {
  NodeDamping local;
  bool coupled = false;
  for (const auto& each : forces_) coupled = !each->add_node_damping(local) || coupled;
  if (pull_) pull_->add_node_damping(local);
  if (coupled) return solve_coupled(weight, local, position, velocity, force);
  solve_per_node(weight, local, velocity);
  return 0;
}

void ForceModel::solve_per_node(double weight, const NodeDamping& damping, Vec3Field& velocity) {
  const NodeMatrix matrix(*system_, weight, damping, inverse_diagonal_);
  const bool holds = damping.held_particle >= 0;
  const auto held = static_cast<std::size_t>(std::max(damping.held_particle, 0));
  const Vec3 of_held = system_->mass[held] * velocity[held] + weight * position_force_[held];

  OwnStrip own;
  for_each_strip(velocity.size(), [&](std::size_t first, std::size_t count) {
    const Strip<double> v = strip_of(velocity, first, count), rhs = own.of(count);
    right_hand_side(system_->mass.data() + first, weight, v, read_strip(position_force_, first, count), rhs);
    matrix.solve(first, rhs, v);
  });
  if (holds) {
    const Vec3 n = damping.normal ? (*damping.normal)[held] : Vec3::Zero();
    const double diagonal = system_->mass[held] + weight * (damping.isotropic + damping.held_isotropic);
    const double along = weight * damping.along_normal;
    velocity.set(held, (of_held - along / (diagonal + along) * n.dot(of_held) * n) / diagonal);
  }
}

/// product = the part of D v that couples particles, and the hand's. Returns what it takes, in W.
double ForceModel::coupled_product(const Vec3Field& position, const Vec3Field& velocity,
                                   Vec3Field& product) const {
  const double dampers = swept_dampers(position, velocity, product);
  bool is_all = sweeps_dampers() && !pull_;
  for (const auto& force : forces_) {
    NodeDamping unused;
    if (is_swept(*force) || force->add_node_damping(unused)) continue;
    force->add_damping(position, velocity, product);
    is_all = false;
  }
  if (pull_) pull_->add_damping(position, velocity, product);
  return is_all ? dampers : cloth::dot(velocity.flat(), product.flat());
}

/// `product` holds a force for the guess.
int ForceModel::solve_coupled(double weight, const NodeDamping& local, const Vec3Field& position,
                              Vec3Field& velocity, Vec3Field& product) {
  const std::size_t size = velocity.size();
  if (residual_.size() != size) residual_ = direction_ = Vec3Field(size);
  const NodeMatrix matrix(*system_, weight, local, inverse_diagonal_);
  OwnStrip own;

  double goal = 0;
  for_each_strip(size, [&](std::size_t first, std::size_t count) {
    const Strip<double> v = strip_of(velocity, first, count), r = strip_of(residual_, first, count),
                        z = own.of(count);
    right_hand_side(system_->mass.data() + first, weight, v, read_strip(position_force_, first, count), r);
    matrix.solve(first, r, z);
    goal += dot(r, z);
    accelerate(weight, system_->inverse_mass.data() + first, read_strip(product, first, count), v);
  });
  goal *= tolerance * tolerance;

  coupled_product(position, velocity, product);
  double slope = 0, curvature = 0;
  for_each_strip(size, [&](std::size_t first, std::size_t count) {
    const Strip<double> r = strip_of(residual_, first, count), d = strip_of(direction_, first, count);
    matrix.subtract_product(first, 1, weight, read_strip(velocity, first, count),
                            read_strip(product, first, count), r);
    matrix.solve(first, r, d);
    slope += dot(r, d);
    curvature += matrix.square(first, d);
  });

  int iterations = 0;
  while (iterations < max_iterations && slope > goal) {
    curvature += weight * coupled_product(position, direction_, product);
    if (!(curvature > 0)) break;
    const double length = slope / curvature;
    double next_slope = 0;
    for_each_strip(size, [&](std::size_t first, std::size_t count) {
      const Strip<double> r = strip_of(residual_, first, count), z = own.of(count);
      const auto d = read_strip(direction_, first, count);
      advance(length, d, strip_of(velocity, first, count));
      matrix.subtract_product(first, length, weight, d, read_strip(product, first, count), r);
      matrix.solve(first, r, z);
      next_slope += dot(r, z);
    });
    const double keep = next_slope / slope;
    curvature = 0;
    for_each_strip(size, [&](std::size_t first, std::size_t count) {
      const Strip<double> d = strip_of(direction_, first, count), z = own.of(count);
      matrix.solve(first, read_strip(residual_, first, count), z);
      turn(keep, z, d);
      curvature += matrix.square(first, d);
    });
    slope = next_slope;
    ++iterations;
  }
  return iterations;
}

}  // namespace cloth
