#include "cloth/bending_sliders.h"

#include <algorithm>
#include <cmath>

#include "cloth/cloth_system.h"
#include "cloth/normals.h"

namespace cloth {
namespace {

/// kappa - slip, 1/m.
double stretch_of(const BendingSlider& s, std::size_t k, const SliderState& state,
                  const Vec3Field& position) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
    sum += s.coefficient[p] * position[at(s.particle[p])];
  return state.normal[k].dot(sum) - state.slip[k];
}

double moment_of(const BendingSlider& s, double stretch) {
  return std::clamp(s.stiffness * stretch, -s.yield, s.yield);
}

void take_normals(const ClothSystem& system, const Vec3Field& position, Vec3Field& normal) {
  Vec3Field of_particles(position.size());
  particle_normals(system, position, of_particles);
  for (std::size_t k = 0; k < system.sliders.size(); ++k) {
    const BendingSlider& s = system.sliders[k];
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.normal_points); ++p)
      sum += of_particles[at(s.particle[p])];
    const double length = sum.norm();
    normal.set(k, length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero()));
  }
}

}  // namespace

SliderState sliders_at(const ClothSystem& system, const Vec3Field& position) {
  SliderState state{std::vector<double>(system.sliders.size(), 0.0), Vec3Field(system.sliders.size())};
  take_normals(system, position, state.normal);
  return state;
}

double slider_energy(const BendingSliders& sliders, const SliderState& state, const Vec3Field& position) {
  double sum = 0;
  for (std::size_t k = 0; k < sliders.size(); ++k) {
    const BendingSlider& s = sliders[k];
    const double stretch = std::abs(stretch_of(s, k, state, position)), most = s.yield / s.stiffness;
    sum += s.area * (stretch <= most ? 0.5 * s.stiffness * stretch * stretch
                                     : s.yield * (stretch - 0.5 * most));
  }
  return sum;
}

void add_slider_force(const BendingSliders& sliders, const SliderState& state, const Vec3Field& position,
                      Vec3Field& force) {
  for (std::size_t k = 0; k < sliders.size(); ++k) {
    const BendingSlider& s = sliders[k];
    const Vec3 push = -s.area * moment_of(s, stretch_of(s, k, state, position)) * state.normal[k];
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      force.add(at(s.particle[p]), s.coefficient[p] * push);
  }
}

double end_slider_step(const ClothSystem& system, const Vec3Field& position, SliderState& state) {
  const double before = slider_energy(system.sliders, state, position);
  for (std::size_t k = 0; k < system.sliders.size(); ++k) {
    const BendingSlider& s = system.sliders[k];
    const double stretch = stretch_of(s, k, state, position), most = s.yield / s.stiffness;
    state.slip[k] += stretch - std::clamp(stretch, -most, most);
  }
  take_normals(system, position, state.normal);
  return before - slider_energy(system.sliders, state, position);
}

std::vector<double> slider_slopes(const BendingSliders& sliders, const SliderState& state,
                                  const Vec3Field& position) {
  std::vector<double> slopes(sliders.size());
  for (std::size_t k = 0; k < sliders.size(); ++k) {
    const BendingSlider& s = sliders[k];
    const bool yields = std::abs(s.stiffness * stretch_of(s, k, state, position)) > s.yield;
    slopes[k] = yields ? 0 : s.stiffness * s.area;
  }
  return slopes;
}

}  // namespace cloth
