#include "kernels/coloured_springs.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

using kernels::widest_vector;

/// The first number that is in neither list.
int first_free(const std::vector<int>& a, const std::vector<int>& b, std::vector<int>& taken_for, int now) {
  for (const std::vector<int>* list : {&a, &b})
    for (const int colour : *list) {
      if (at(colour) >= taken_for.size()) taken_for.resize(at(colour) + 1, -1);
      taken_for[at(colour)] = now;
    }
  const auto free = std::find_if(taken_for.begin(), taken_for.end(), [&](int t) { return t != now; });
  return static_cast<int>(free - taken_for.begin());
}

int filled_up(int count) {
  return (count + widest_vector - 1) / widest_vector * widest_vector;
}

}  // namespace

SpringOrder order_by_colours(const ClothSystem& system) {
  constexpr std::size_t fewest_springs = 16;  // of a colour on average
  std::vector<std::vector<int>> colours_at(system.mass.size()), of_colour;
  std::vector<int> taken_for;
  SpringOrder order;
  for_each_spring(system.springs,
                  [&](const SpringRun& run, std::size_t spring, std::size_t i, std::size_t j) {
                    if (!(run.stiffness > 0)) return;
                    const auto number = static_cast<int>(spring);
                    const int colour = first_free(colours_at[i], colours_at[j], taken_for, number);
                    if (at(colour) >= of_colour.size()) of_colour.resize(at(colour) + 1);
                    colours_at[i].push_back(colour), colours_at[j].push_back(colour);
                    of_colour[at(colour)].push_back(number);
                    order.springs.push_back(number);
                  });
  order.fills_vectors = !of_colour.empty() && order.springs.size() >= fewest_springs * of_colour.size();
  if (!order.fills_vectors) return order;
  order.springs.clear();
  order.colour_begin.push_back(0);
  for (const std::vector<int>& springs : of_colour) {
    order.springs.insert(order.springs.end(), springs.begin(), springs.end());
    order.colour_begin.push_back(static_cast<int>(order.springs.size()));
  }
  return order;
}

ColouredSprings::ColouredSprings(const ClothSystem& system)
    : springs_(system.springs), kernels_(&active_kernels<kernels::LocalKernels>()) {
  const SpringOrder order = order_by_colours(system);
  by_vectors_ = order.fills_vectors || order.springs.empty();
  if (!by_vectors_) return;
  std::vector<int> place(system.springs.spring_count(), -1);
  int count = 0;
  for (std::size_t c = 0; c + 1 < order.colour_begin.size(); ++c) {
    for (int k = order.colour_begin[c]; k < order.colour_begin[c + 1]; ++k)
      place[at(order.springs[at(k)])] = count++;
    count = filled_up(count);
  }
  const int nobody = 4 * static_cast<int>(system.mass.size());
  first_.assign(at(count), nobody), second_.assign(at(count), nobody);
  stiffness_.assign(at(count), 0), rest_length_.assign(at(count), 0);
  for_each_spring(springs_, [&](const SpringRun& run, std::size_t spring, std::size_t i, std::size_t j) {
    if (place[spring] < 0) return;
    const std::size_t k = at(place[spring]);
    first_[k] = 4 * static_cast<int>(i), second_[k] = 4 * static_cast<int>(j);
    stiffness_[k] = run.stiffness, rest_length_[k] = run.rest_length;
  });
  pass_.springs = count;
  pass_.first = first_.data(), pass_.second = second_.data();
}

/// h k/q and so on, with q = 1 + h (h k + k_d) (w_i + w_j); of a rigid spring their limits.
void ColouredSprings::begin(double step, const Dampers& dampers, const std::vector<double>& mobility) {
  const bool is_known = step == pass_.step && dampers == dampers_ &&
                        mobility_.size() == mobility.size() + 1 &&
                        std::equal(mobility.begin(), mobility.end(), mobility_.begin());
  if (is_known) return;
  pass_.step = step, dampers_ = dampers;
  pass_.is_damped = dampers.each > 0 || dampers.per_stiffness > 0;
  mobility_ = mobility;
  mobility_.push_back(0);
  for (auto* numbers : {&stretch_, &tension_, &damper_, &turn_, &both_}) numbers->resize(first_.size());
  for (std::size_t s = 0; s < first_.size(); ++s) {
    const double k = stiffness_[s], both = mobility_[at(first_[s] / 4)] + mobility_[at(second_[s] / 4)];
    const double damping = dampers.each + dampers.per_stiffness * k;
    both_[s] = both;
    if (std::isinf(k)) {
      stretch_[s] = both > 0 ? 1 / (step * both) : 0;
      damper_[s] = 0, turn_[s] = both > 0 ? 1 / both : 0;
    } else {
      const double impulse = step * (step * k + damping), share = 1 / (1 + impulse * both);
      stretch_[s] = step * k * share, damper_[s] = step * damping * share, turn_[s] = impulse * share;
    }
    tension_[s] = stretch_[s] * rest_length_[s];
  }
  pass_.stretch = stretch_.data(), pass_.tension = tension_.data(), pass_.damper = damper_.data();
  pass_.turn = turn_.data(), pass_.both = both_.data();
  pass_.mobility = mobility_.data();
}

void ColouredSprings::store(const Vec3Field& field, AlignedDoubles& vectors) const {
  vectors.resize(4 * (field.size() + 1));  // the last one, which fills up, is 0
  kernels_->to_vectors(field.x(), field.y(), field.z(), vectors.data(), static_cast<int>(field.size()));
}

void ColouredSprings::give(Vec3Field& velocity) const {
  kernels_->from_vectors(velocity_.data(), velocity.x(), velocity.y(), velocity.z(),
                         static_cast<int>(velocity.size()));
}

void ColouredSprings::begin_substep(const Vec3Field& position, const Vec3Field& velocity,
                                    const Vec3Field* drag, bool keeps_impulses) {
  store(position, position_);
  store(velocity, velocity_);
  pass_.velocity = velocity_.data();
  if (drag) store(*drag, drag_);
  pass_.position = position_.data();
  pass_.drag = drag ? drag_.data() : nullptr;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (keeps_impulses) impulse_[axis].assign(first_.size(), 0.0);
    pass_.impulse[axis] = keeps_impulses ? impulse_[axis].data() : nullptr;
  }
}

double ColouredSprings::visit(bool measured) {
  pass_.measures = measured;
  kernels_->project(pass_);
  return pass_.largest_change;
}

}  // namespace cloth
