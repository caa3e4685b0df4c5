// What is done between two products with D goes through the particles in strips that stay in the nearest
// cache.
#include "forces/velocity_solver.h"

#include <algorithm>
#include <numeric>

#include "cloth/sums.h"
#include "forces/node_matrix.h"
#include "kernels/in_shares.h"

namespace cloth {
namespace {

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

int VelocitySolver::solve(const ForceModel& forces, double weight, double tolerance,
                          const Vec3Field& position, Vec3Field& velocity, Vec3Field& force) {
  const NodeDamping local = forces.damping_parts();
  if (forces.couples_particles()) {
    team_ = forces.solve_job().begin();
    const int iterations = solve_coupled(forces, weight, tolerance, local, position, velocity, force);
    forces.solve_job().end();
    return iterations;
  }
  solve_by_particle(forces.system(), forces.position_force(), weight, local, velocity);
  return 0;
}

void VelocitySolver::solve_by_particle(const ClothSystem& system, const Vec3Field& position_force,
                                       double weight, const NodeDamping& damping, Vec3Field& velocity) {
  const NodeMatrix matrix(system, weight, damping, inverse_diagonal_);
  const bool holds = damping.held_particle >= 0;
  const auto held = static_cast<std::size_t>(std::max(damping.held_particle, 0));
  const Vec3 of_held = system.mass[held] * velocity[held] + weight * position_force[held];

  OwnStrip own;
  for_each_strip(velocity.size(), [&](std::size_t first, std::size_t count) {
    const Strip<double> v = strip_of(velocity, first, count), rhs = own.of(count);
    right_hand_side(system.mass.data() + first, weight, v, read_strip(position_force, first, count), rhs);
    matrix.solve(first, rhs, v);
  });
  if (holds) {
    const Vec3 n = damping.normal ? (*damping.normal)[held] : Vec3::Zero();
    const double diagonal =
        system.mass[held] + weight * (damping.isotropic.of(system.mass[held]) + damping.held_isotropic);
    const double along = weight * damping.along_normal.of(system.mass[held]);
    velocity.set(held, (of_held - along / (diagonal + along) * n.dot(of_held) * n) / diagonal);
  }
}

template <class Visit>
double VelocitySolver::sum_over_strips(std::size_t size, const Visit& visit) {
  constexpr std::size_t least_strips = 8;
  of_strips_.resize((size + particles_of_strip - 1) / particles_of_strip);
  in_shares(team_, of_strips_.size(), least_strips, [&](int, std::size_t begin, std::size_t end) {
    OwnStrip own;
    for (std::size_t strip = begin; strip < end; ++strip) {
      const std::size_t first = strip * particles_of_strip;
      of_strips_[strip] = visit(first, std::min(particles_of_strip, size - first), own);
    }
  });
  return std::accumulate(of_strips_.begin(), of_strips_.end(), 0.0);
}

/// `product` holds a force for the guess.
int VelocitySolver::solve_coupled(const ForceModel& forces, double weight, double tolerance,
                                  const NodeDamping& local, const Vec3Field& position, Vec3Field& velocity,
                                  Vec3Field& product) {
  const ClothSystem& system = forces.system();
  const std::size_t size = velocity.size();
  if (residual_.size() != size) residual_ = direction_ = Vec3Field(size);
  const NodeMatrix matrix(system, weight, local, inverse_diagonal_);

  double goal = sum_over_strips(size, [&](std::size_t first, std::size_t count, OwnStrip& own) {
    const Strip<double> v = strip_of(velocity, first, count), r = strip_of(residual_, first, count),
                        z = own.of(count);
    right_hand_side(system.mass.data() + first, weight, v, read_strip(forces.position_force(), first, count),
                    r);
    matrix.solve(first, r, z);
    accelerate(weight, system.inverse_mass.data() + first, read_strip(product, first, count), v);
    return dot(r, z);
  });
  goal *= tolerance * tolerance;

  forces.coupled_damping(position, velocity, product);
  double slope = sum_over_strips(size, [&](std::size_t first, std::size_t count, OwnStrip&) {
    const Strip<double> r = strip_of(residual_, first, count), d = strip_of(direction_, first, count);
    matrix.subtract_product(first, 1, weight, read_strip(velocity, first, count),
                            read_strip(product, first, count), r);
    matrix.solve(first, r, d);
    return dot(r, d);
  });
  double curvature = sum_over_strips(size, [&](std::size_t first, std::size_t count, OwnStrip&) {
    return matrix.square(first, strip_of(direction_, first, count));
  });

  int iterations = 0;
  while (iterations < max_iterations && slope > goal) {
    curvature += weight * forces.coupled_damping(position, direction_, product);
    if (!(curvature > 0)) break;
    const double length = slope / curvature;
    const double next_slope = sum_over_strips(size, [&](std::size_t first, std::size_t count, OwnStrip& own) {
      const Strip<double> r = strip_of(residual_, first, count), z = own.of(count);
      const auto d = read_strip(direction_, first, count);
      advance(length, d, strip_of(velocity, first, count));
      matrix.subtract_product(first, length, weight, d, read_strip(product, first, count), r);
      matrix.solve(first, r, z);
      return dot(r, z);
    });
    const double keep = next_slope / slope;
    curvature = sum_over_strips(size, [&](std::size_t first, std::size_t count, OwnStrip& own) {
      const Strip<double> d = strip_of(direction_, first, count), z = own.of(count);
      matrix.solve(first, read_strip(residual_, first, count), z);
      turn(keep, z, d);
      return matrix.square(first, d);
    });
    slope = next_slope;
    ++iterations;
  }
  return iterations;
}

}  // namespace cloth
