#include "bench/speed/reference_kernel.h"

#include <algorithm>
#include <cmath>

namespace cloth::speed {

ReferenceKernel::ReferenceKernel(const Scene& scene, const ClothSystem& system, const ClothState& state)
    : damping_(scene.damping.value_or(0)) {
  const Vec3 gravity = gravity_of(scene);
  for (int axis = 0; axis < 3; ++axis) weight_[axis] = system.mass.front() * gravity[axis];
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3 x = state.position[i], v = state.velocity[i];
    particles_.push_back({{x.x(), x.y(), x.z()}, {v.x(), v.y(), v.z()}, {0, 0, 0}, system.inverse_mass[i]});
  }
  for (const SpringRun& run : system.springs)
    for (int s = 0; s < run.count; ++s)
      springs_.push_back({run.first + s, run.first + s + run.offset, run.rest_length, run.stiffness});
}

void ReferenceKernel::step(double h) {
  for (Particle& p : particles_)
    for (int axis = 0; axis < 3; ++axis) p.f[axis] = weight_[axis] - damping_ * p.v[axis];

  for (const Spring& spring : springs_) {
    Particle& a = particles_[static_cast<std::size_t>(spring.i)];
    Particle& b = particles_[static_cast<std::size_t>(spring.j)];
    const double dx = b.x[0] - a.x[0], dy = b.x[1] - a.x[1], dz = b.x[2] - a.x[2];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    if (!(length > 0)) continue;
    const double scale = spring.stiffness * (1 - spring.rest_length / length);
    a.f[0] += scale * dx, a.f[1] += scale * dy, a.f[2] += scale * dz;
    b.f[0] -= scale * dx, b.f[1] -= scale * dy, b.f[2] -= scale * dz;
  }

  for (Particle& p : particles_)
    for (int axis = 0; axis < 3; ++axis) {
      p.v[axis] += h * p.inverse_mass * p.f[axis];
      p.x[axis] += h * p.v[axis];
    }
}

double ReferenceKernel::distance_to(const Vec3Field& position) const {
  double largest = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const double* x = particles_[i].x;
    largest = std::max(largest, (Vec3(x[0], x[1], x[2]) - position[i]).norm());
  }
  return largest;
}

}  // namespace cloth::speed
