#include "measure/probe_reader.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "cloth/mesh_cloth.h"
#include "geometry/bounds.h"
#include "measure/drape.h"
#include "measure/droop.h"
#include "measure/energy.h"
#include "measure/probe_measures.h"

namespace cloth {
namespace {

using Values = std::vector<double>;
constexpr double not_defined = std::numeric_limits<double>::quiet_NaN();

/// What the readings below share.
struct Look {
  const ClothSystem& system;
  const ClothState& state;
  const std::vector<Triangle>& triangles;
  Vec3 up, gravity, middle;
};

Eigen::AlignedBox3d box_around(const Vec3Field& position) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < position.size(); ++i) box.extend(Vec3(position[i]));
  return box;
}

std::vector<Vec3> points_at(const Vec3Field& position, const std::vector<int>& particles) {
  std::vector<Vec3> points;
  points.reserve(particles.size());
  for (const int particle : particles) points.push_back(position[static_cast<std::size_t>(particle)]);
  return points;
}

/// m, mean over the pins; not a number where nothing is pinned.
double mean_height_of_pins(const Look& look) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < look.state.position.size(); ++i)
    if (look.system.pinned[i]) sum += look.state.position[i].dot(look.up), ++count;
  return count > 0 ? sum / count : not_defined;
}

double relative_change(double now, double before) {
  return before > 0 ? now / before - 1 : not_defined;
}

void read_particle(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  const auto particle = static_cast<std::size_t>(probed.particles.front());
  const Vec3 at = look.state.position[particle], velocity = look.state.velocity[particle];
  values.insert(values.end(),
                {at.x(), at.y(), at.z(), velocity.norm(), mean_height_of_pins(look) - at.dot(look.up)});
}

void read_distance(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  const double distance = length_of(points_at(look.state.position, probed.particles));
  values.insert(values.end(), {distance, relative_change(distance, probed.start_length)});
}

void read_angle(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  const std::vector<Vec3> p = points_at(look.state.position, probed.particles);
  values.insert(values.end(), {angle_at(p[0], p[1], p[2]), curvature_through(p[0], p[1], p[2])});
}

void read_line(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  constexpr double prominent = 0.02;  // of the length at the start
  const std::vector<Vec3> points = points_at(look.state.position, probed.particles);
  const double length = length_of(points);
  values.insert(values.end(),
                {length, relative_change(length, probed.start_length), sag_below_chord(points, look.up),
                 largest_curvature(points), folds_along(points, look.up, prominent * probed.start_length)});
}

void read_lowest_point(const Look& look, const ProbeReader::Probed&, Values& values) {
  values.push_back(measure_droop(look.system, look.state.position, look.gravity).lowest);
}

void read_extent(const Look& look, const ProbeReader::Probed&, Values& values) {
  const Vec3 sides = box_around(look.state.position).sizes();
  values.insert(values.end(), {sides.x(), sides.y(), sides.z()});
}

void read_shadow(const Look& look, const ProbeReader::Probed&, Values& values) {
  constexpr int lines = 500;
  values.push_back(shadow_area(look.triangles, look.state.position,
                               {.middle = look.middle, .radius = 0, .up = look.up}, lines));
}

void read_drape(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  const Drape drape = measure_drape(look.triangles, look.system.start, look.state.position,
                                    {.middle = look.middle, .radius = probed.probe.radius, .up = look.up});
  values.insert(values.end(), {drape.coefficient, static_cast<double>(drape.folds)});
}

void read_droop(const Look& look, const ProbeReader::Probed&, Values& values) {
  const Droop droop = measure_droop(look.system, look.state.position, look.gravity);
  values.insert(values.end(), {droop.drop, droop.reach, droop.ratio()});
}

void read_rest(const Look& look, const ProbeReader::Probed& probed, Values& values) {
  values.push_back(kinetic_energy(look.system, look.state.velocity) < probed.probe.bound ? 1 : 0);
}

using Reading = void (*)(const Look&, const ProbeReader::Probed&, Values&);

Reading reading_of(ProbeMeasure measure) {
  switch (measure) {
    case ProbeMeasure::particle:
      return read_particle;
    case ProbeMeasure::distance:
      return read_distance;
    case ProbeMeasure::angle:
      return read_angle;
    case ProbeMeasure::line:
      return read_line;
    case ProbeMeasure::lowest_point:
      return read_lowest_point;
    case ProbeMeasure::extent:
      return read_extent;
    case ProbeMeasure::shadow:
      return read_shadow;
    case ProbeMeasure::drape:
      return read_drape;
    case ProbeMeasure::droop:
      return read_droop;
    case ProbeMeasure::rest:
      return read_rest;
  }
  return nullptr;
}

}  // namespace

ProbeReader::ProbeReader(const Scene& scene, const ClothSystem& system)
    : columns_(probe_columns(scene.probes)), gravity_(gravity_of(scene)) {
  if (scene.probes.empty()) return;
  if (gravity_.norm() > 0) up_ = -gravity_.normalized();
  middle_ = box_around(system.start).center();
  for (const Probe& probe : scene.probes) {
    Probed& probed = probes_.emplace_back(Probed{probe, probed_particles(scene.cloth, probe)});
    probed.start_length = length_of(points_at(system.start, probed.particles));
    const bool has_shadow = probe.measure == ProbeMeasure::shadow || probe.measure == ProbeMeasure::drape;
    if (has_shadow && triangles_.empty()) triangles_ = triangles_of(system);
  }
}

std::vector<double> ProbeReader::read(const ClothSystem& system, const ClothState& state) const {
  Values values;
  if (probes_.empty()) return values;
  const Look look{system, state, triangles_, up_, gravity_, middle_};
  for (const Probed& probed : probes_) reading_of(probed.probe.measure)(look, probed, values);
  assert(values.size() == columns_.size());
  return values;
}

}  // namespace cloth
