#include "kernels/particle_descent.h"

#include <algorithm>
#include <utility>

#include "geometry/at.h"
#include "kernels/instruction_set.h"

namespace cloth {

ParticleDescent::ParticleDescent() : local_kernels_(&active_kernels<kernels::LocalKernels>()) {}

void ParticleDescent::make_room(std::vector<int> place_of, int places, kernels::DescentFields& fields) {
  place_of_ = std::move(place_of);
  fields_ = &fields;
  fields.places = places;
  mass_.assign(at(places), 1.0), free_.assign(at(places), 0.0);
  fields.mass = mass_.data(), fields.free = free_.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (Stored* field : {&position_, &shift_}) (*field)[axis].assign(at(places), 0.0);
    fields.position[axis] = position_[axis].data(), fields.shift[axis] = shift_[axis].data();
  }
}

void ParticleDescent::store(const Vec3Field& field, Stored& to) const {
  const double* const from[] = {field.x(), field.y(), field.z()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    to[axis].resize(mass_.size());
    for (std::size_t i = 0; i < place_of_.size(); ++i) to[axis][at(place_of_[i])] = from[axis][i];
  }
}

void ParticleDescent::begin(const Start& start) {
  step_ = start.step;
  const double over_square = 1 / (step_ * step_);
  for (std::size_t i = 0; i < place_of_.size(); ++i) {
    const double mass = start.mass[i];
    free_[at(place_of_[i])] = mass > 0 ? 1 : 0;
    mass_[at(place_of_[i])] = mass > 0 ? mass * over_square : 1;
  }
  predicted_ = start.predicted;
  Vec3Field inertial = start.position;
  const auto to = inertial.flat();
  const auto from = start.predicted.flat();
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += step_ * from[k];
  store(inertial, position_);
  const bool is_damped =
      start.spring_damping > 0 || start.stretch_time > 0 || start.bending_time > 0 || start.membrane_time > 0;
  fields_->damper = start.spring_damping / step_;
  if (is_damped) store(start.position, start_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill(shift_[axis].begin(), shift_[axis].end(), 0.0);
    fields_->start[axis] = is_damped ? start_[axis].data() : nullptr;
    if (start.extrapolates) before_[axis].assign(mass_.size(), 0.0), present_[axis].assign(mass_.size(), 0.0);
    fields_->before[axis] = start.extrapolates ? before_[axis].data() : nullptr;
    if (start.has_drag) drag_[axis].assign(mass_.size(), 0.0);
    fields_->drag[axis] = start.has_drag ? drag_[axis].data() : nullptr;
  }
  begin_visits(start);
}

void ParticleDescent::set_drag(const Vec3Field& drag, const Vec3Field& predicted) {
  const double* const b[] = {drag.x(), drag.y(), drag.z()};
  const double* const now[] = {predicted.x(), predicted.y(), predicted.z()};
  const double* const old[] = {predicted_.x(), predicted_.y(), predicted_.z()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool has_before = fields_->before[axis] != nullptr;
    for (std::size_t i = 0; i < place_of_.size(); ++i) {
      const std::size_t place = at(place_of_[i]);
      drag_[axis][place] = b[axis][i] / step_;
      const double less = step_ * (now[axis][i] - old[axis][i]);
      shift_[axis][place] -= less;
      if (has_before) before_[axis][place] -= less;
    }
  }
  predicted_ = predicted;
}

ParticleDescent::Sums ParticleDescent::sweep() {
  if (fields_->before[0])
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::copy(shift_[axis].begin(), shift_[axis].end(), present_[axis].begin());
  visit_all();
  const double square = step_ * step_;
  return {fields_->largest_change / square, fields_->squares / square};
}

void ParticleDescent::extrapolate(double weight) {
  if (weight > 1) {
    local_kernels_->extrapolate(*fields_, weight);
    positions_have_moved();
  }
  std::swap(before_, present_);
  for (std::size_t axis = 0; axis < 3; ++axis) fields_->before[axis] = before_[axis].data();
}

void ParticleDescent::read_positions(Vec3Field& position) const {
  double* const to[] = {position.x(), position.y(), position.z()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < place_of_.size(); ++i) to[axis][i] = position_[axis][at(place_of_[i])];
}

void ParticleDescent::end(Vec3Field& velocity) const {
  velocity = predicted_;
  double* const to[] = {velocity.x(), velocity.y(), velocity.z()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < place_of_.size(); ++i) to[axis][i] += shift_[axis][at(place_of_[i])] / step_;
}

}  // namespace cloth
