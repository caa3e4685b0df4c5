#include "bridge/fill_frame.h"

#include <algorithm>

#include "cloth/normals.h"
#include "measure/strain.h"

namespace clothlab {
namespace {

/// x y z of particle 0, of particle 1, ...
void interleave(const cloth::Vec3Field& field, std::vector<float>& values) {
  values.resize(3 * field.size());
  const double *x = field.x(), *y = field.y(), *z = field.z();
  float* out = values.data();
  for (std::size_t i = 0; i < field.size(); ++i) {
    out[3 * i] = static_cast<float>(x[i]);
    out[3 * i + 1] = static_cast<float>(y[i]);
    out[3 * i + 2] = static_cast<float>(z[i]);
  }
}

void fill_poses(const cloth::Simulation& simulation, double time, ClothFrame& frame) {
  const auto& obstacles = simulation.scene().obstacles;
  frame.poses.clear();
  frame.targets.clear();
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    frame.poses.push_back(simulation.obstacle_pose(k, time));
    frame.targets.push_back(cloth::pose_of(obstacles[k], time));
  }
}

float largest_of(const std::vector<float>& strain) {
  float largest = 0;
  for (const float value : strain)
    if (value > largest) largest = value;  // false for NaN
  return largest;
}

}  // namespace

void show_difference(const std::vector<float>& distance, ClothFrame& frame) {
  frame.shows_difference = true;
  if (distance.empty())
    std::fill(frame.strain.begin(), frame.strain.end(), 0.0F);
  else
    frame.strain = distance;
  frame.largest_strain = largest_of(frame.strain);
}

void fill_frame(const cloth::Simulation& simulation, const cloth::ClothState& state,
                cloth::Vec3Field& normals, ClothFrame& frame) {
  const cloth::ClothSystem& system = simulation.system();
  const cloth::Vec3Field& position = state.position;
  frame.rows = system.rows;
  frame.columns = system.columns;
  frame.mesh = simulation.surface();
  interleave(position, frame.positions);
  if (normals.size() != position.size()) normals = cloth::Vec3Field(position.size());
  cloth::particle_normals(system, position, normals);
  interleave(normals, frame.normals);
  frame.strain.resize(position.size());
  cloth::particle_strain(system, position, frame.strain);
  frame.largest_strain = largest_of(frame.strain);
  frame.pinned = system.pinned;
  frame.obstacles = simulation.scene().obstacles;
  fill_poses(simulation, state.time, frame);
  frame.probes = simulation.probes().probes();
  frame.probe_values = simulation.probes().read(system, state);
  const auto& deformation = simulation.scene().deformation;
  frame.deformation_rate = simulation.quantities().limiter ? deformation->rate : -1;
  frame.time = state.time;
  frame.step = state.step;
  frame.shows_difference = false;
}

}  // namespace clothlab
