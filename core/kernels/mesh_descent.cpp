#include "kernels/mesh_descent.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "kernels/mesh_pass.h"

namespace cloth {
namespace {

using kernels::widest_vector;

/// Where each slice's slots begin, if every particle's `entries_of(particle)` get a lane of one each.
template <class EntriesOf>
std::vector<int> slots_of_slices(const std::vector<int>& particle_at, const EntriesOf& entries_of) {
  std::vector<int> begin{0};
  for (std::size_t first = 0; first < particle_at.size(); first += widest_vector) {
    std::size_t most = 0;
    for (std::size_t place = first; place < first + widest_vector; ++place)
      if (particle_at[place] >= 0) most = std::max(most, entries_of(at(particle_at[place])).size());
    begin.push_back(begin.back() + static_cast<int>(most));
  }
  return begin;
}

/// visit(slot, lane, entry, place) of every entry.
template <class EntriesOf, class Visit>
void for_each_slot(const std::vector<int>& particle_at, const std::vector<int>& begin,
                   const EntriesOf& entries_of, const Visit& visit) {
  for (std::size_t place = 0; place < particle_at.size(); ++place) {
    if (particle_at[place] < 0) continue;
    std::size_t slot = at(begin[place / widest_vector]);
    for (const auto& entry : entries_of(at(particle_at[place])))
      visit(slot++, place % widest_vector, entry, place);
  }
}

std::size_t count_of(const std::vector<int>& begin) {
  return widest_vector * at(begin.back());
}
std::size_t place_of_number(std::size_t slot, int numbers, int number, std::size_t lane) {
  return (slot * at(numbers) + at(number)) * widest_vector + lane;
}

}  // namespace

bool MeshDescent::suits(const SpringRuns& springs) {
  return std::all_of(springs.blocks().begin(), springs.blocks().end(), [](const SpringBlock& block) {
    return std::isfinite(block.run.stiffness * block.run.rest_length) && std::isfinite(block.run.stiffness);
  });
}

MeshDescent::MeshDescent(const ClothSystem& system, const ParticleElements& elements) {
  place_particles(elements);
  make_springs(elements);
  if (!system.bending.empty()) make_bending(elements);
  if (!system.membrane.empty()) make_triangles(system, elements);
  if (!system.sliders.empty()) make_sliders(system, elements);
  for (AlignedDoubles* vectors : {&vectors_, &start_vectors_}) {
    vectors->assign(4 * (particle_at_.size() + 1), 0.0);
    std::copy(std::begin(kernels::nowhere), std::end(kernels::nowhere), vectors->end() - 4);
  }
  descent_.vectors = vectors_.data();
}

void MeshDescent::place_particles(const ParticleElements& elements) {
  const auto count = [&](int i) {
    return elements.springs(at(i)).size() + elements.bending(at(i)).size() +
           elements.triangles(at(i)).size() + elements.sliders(at(i)).size();
  };
  std::size_t particles = 0;
  for (const std::vector<int>& colour : elements.colours()) particles += colour.size();
  std::vector<int> place_of(particles);
  for (std::vector<int> colour : elements.colours()) {
    std::stable_sort(colour.begin(), colour.end(), [&](int i, int j) { return count(i) > count(j); });
    for (const int i : colour) {
      place_of[at(i)] = static_cast<int>(particle_at_.size());
      particle_at_.push_back(i);
    }
    while (particle_at_.size() % widest_vector != 0) particle_at_.push_back(-1);
  }
  const auto places = static_cast<int>(particle_at_.size());
  descent_.slices = places / widest_vector;
  make_room(std::move(place_of), places, descent_);
}

void MeshDescent::make_springs(const ParticleElements& elements) {
  const auto of = [&](std::size_t i) { return elements.springs(i); };
  slot_begin_ = slots_of_slices(particle_at_, of);
  neighbour_.assign(count_of(slot_begin_), 4 * static_cast<int>(particle_at_.size()));
  stiffness_.assign(neighbour_.size(), 0.0), rest_length_.assign(neighbour_.size(), 0.0);
  for_each_slot(particle_at_, slot_begin_, of,
                [&](std::size_t slot, std::size_t lane, const SpringEnd& end, std::size_t) {
                  const std::size_t k = slot * widest_vector + lane;
                  neighbour_[k] = 4 * places()[at(end.other)];
                  stiffness_[k] = end.stiffness, rest_length_[k] = end.rest_length;
                });
  descent_.slot_begin = slot_begin_.data(), descent_.neighbour = neighbour_.data();
  descent_.stiffness = stiffness_.data(), descent_.rest_length = rest_length_.data();
}

void MeshDescent::make_bending(const ParticleElements& elements) {
  const auto of = [&](std::size_t i) { return elements.bending(i); };
  bending_.begin = slots_of_slices(particle_at_, of);
  bending_.neighbour.assign(count_of(bending_.begin), 4 * static_cast<int>(particle_at_.size()));
  bending_.coupling.assign(bending_.neighbour.size(), 0.0);
  for (AlignedDoubles* field : {&bending_.own, &bending_.held[0], &bending_.held[1], &bending_.held[2]})
    field->assign(particle_at_.size(), 0.0);
  for_each_slot(particle_at_, bending_.begin, of,
                [&](std::size_t slot, std::size_t lane, const BendingEntry& entry, std::size_t place) {
                  bending_.neighbour[slot * widest_vector + lane] = 4 * places()[at(entry.other)];
                  bending_.coupling[slot * widest_vector + lane] = entry.stiffness;
                  bending_.own[place] -= entry.stiffness;
                });
  kernels::BendingSlots& slots = descent_.bending;
  slots.begin = bending_.begin.data(), slots.neighbour = bending_.neighbour.data();
  slots.coupling = bending_.coupling.data(), slots.own = bending_.own.data();
  for (std::size_t axis = 0; axis < 3; ++axis) slots.held[axis] = bending_.held[axis].data();
}

/// The numbers in the order of kernels::TriangleSlots.
void MeshDescent::make_triangles(const ClothSystem& system, const ParticleElements& elements) {
  const auto of = [&](std::size_t i) { return elements.triangles(i); };
  triangles_.begin = slots_of_slices(particle_at_, of);
  triangles_.next.assign(count_of(triangles_.begin), 4 * static_cast<int>(particle_at_.size()));
  triangles_.before = triangles_.next;
  triangles_.numbers.assign(kernels::triangle_numbers * triangles_.next.size(), 0.0);
  for_each_slot(particle_at_, triangles_.begin, of,
                [&](std::size_t slot, std::size_t lane, const ElementPoint& point, std::size_t) {
                  const MembraneTriangle& t = system.membrane[at(point.element)];
                  const std::size_t out = at(point.point), third = (out + 1) % 3, in = (out + 2) % 3;
                  triangles_.next[slot * widest_vector + lane] = 4 * places()[at(t.corner[third])];
                  triangles_.before[slot * widest_vector + lane] = 4 * places()[at(t.corner[in])];
                  const double numbers[] = {t.rest_square[out], t.rest_square[in], t.rest_square[third],
                                            t.k[out][out],      t.k[in][in],       t.k[out][in],
                                            t.k[out][third],    t.k[in][third]};
                  for (int n = 0; n < kernels::triangle_numbers; ++n)
                    triangles_.numbers[place_of_number(slot, kernels::triangle_numbers, n, lane)] =
                        numbers[n];
                });
  kernels::TriangleSlots& slots = descent_.triangles;
  slots.begin = triangles_.begin.data(), slots.numbers = triangles_.numbers.data();
  slots.next = triangles_.next.data(), slots.before = triangles_.before.data();
}

/// What changes from step to step is left to set_sliders().
void MeshDescent::make_sliders(const ClothSystem& system, const ParticleElements& elements) {
  const auto of = [&](std::size_t i) { return elements.sliders(i); };
  sliders_.begin = slots_of_slices(particle_at_, of);
  const std::size_t slots = at(sliders_.begin.back());
  sliders_.element.assign(count_of(sliders_.begin), -1);
  sliders_.numbers.assign(kernels::slider_numbers * sliders_.element.size(), 0.0);
  std::vector<int> most(slots, 0);
  for_each_slot(
      particle_at_, sliders_.begin, of,
      [&](std::size_t slot, std::size_t lane, const ElementPoint& point, std::size_t) {
        const BendingSlider& s = system.sliders[at(point.element)];
        sliders_.element[slot * widest_vector + lane] = point.element;
        most[slot] = std::max(most[slot], s.points);
        const double c = s.coefficient[at(point.point)];
        const double numbers[] = {s.area * s.stiffness, s.area * s.yield, c, c != 0 ? 1 / std::abs(c) : 0};
        for (int n = 0; n < 4; ++n)
          sliders_.numbers[place_of_number(slot, kernels::slider_numbers, 4 + n, lane)] = numbers[n];
      });
  sliders_.points.assign(1, 0);
  for (const int points : most) sliders_.points.push_back(sliders_.points.back() + points);
  sliders_.neighbour.assign(count_of(sliders_.points), 4 * static_cast<int>(particle_at_.size()));
  sliders_.coefficient.assign(sliders_.neighbour.size(), 0.0);
  for (std::size_t k = 0; k < sliders_.element.size(); ++k) {
    if (sliders_.element[k] < 0) continue;
    const BendingSlider& s = system.sliders[at(sliders_.element[k])];
    for (std::size_t p = 0; p < at(s.points); ++p) {
      const std::size_t point =
          (at(sliders_.points[k / widest_vector]) + p) * widest_vector + k % widest_vector;
      sliders_.neighbour[point] = 4 * places()[at(s.particle[p])];
      sliders_.coefficient[point] = s.coefficient[p];
    }
  }
  kernels::SliderSlots& to = descent_.sliders;
  to.points = sliders_.points.data(), to.neighbour = sliders_.neighbour.data();
  to.coefficient = sliders_.coefficient.data(), to.numbers = sliders_.numbers.data();
}

void MeshDescent::set_sliders(const SliderState& state) {
  for (std::size_t k = 0; k < sliders_.element.size(); ++k) {
    if (sliders_.element[k] < 0) continue;
    const std::size_t element = at(sliders_.element[k]);
    const Vec3 n = state.normal[element];
    const double numbers[] = {n.x(), n.y(), n.z(), state.slip[element]};
    for (int i = 0; i < 4; ++i)
      sliders_.numbers[place_of_number(k / widest_vector, kernels::slider_numbers, i, k % widest_vector)] =
          numbers[i];
  }
}

/// time sum K_ij (s_j - s_i), `time` over the step and s at its start.
void MeshDescent::hold_bending(double time) {
  const double* const* start = descent_.start;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t place = 0; place < particle_at_.size(); ++place) {
      double sum = 0;
      if (time > 0)
        for (int slot = bending_.begin[place / widest_vector];
             slot < bending_.begin[place / widest_vector + 1]; ++slot) {
          const std::size_t k = at(slot) * widest_vector + place % widest_vector;
          const double coupling = bending_.coupling[k];
          if (coupling != 0) sum += coupling * (start[axis][bending_.neighbour[k] / 4] - start[axis][place]);
        }
      bending_.held[axis][place] = time * sum;
    }
}

void MeshDescent::positions_have_moved() {
  local_kernels().to_vectors(descent_.position[0], descent_.position[1], descent_.position[2],
                             vectors_.data(), descent_.places);
}

void MeshDescent::begin_visits(const Start& start) {
  positions_have_moved();
  descent_.damper_per_stiffness = start.stretch_time / step();
  const double* const* from = descent_.start;
  descent_.start_vectors = from[0] ? start_vectors_.data() : nullptr;
  if (from[0]) local_kernels().to_vectors(from[0], from[1], from[2], start_vectors_.data(), descent_.places);
  if (descent_.bending.begin) {
    descent_.bending.scale = 1 + start.bending_time / step();
    hold_bending(start.bending_time / step());
  }
  descent_.triangles.time = start.membrane_time / step();
  descent_.sliders.begin = start.sliders && !sliders_.begin.empty() ? sliders_.begin.data() : nullptr;
  if (descent_.sliders.begin) set_sliders(*start.sliders);
}

}  // namespace cloth
