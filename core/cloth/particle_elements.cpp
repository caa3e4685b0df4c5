#include "cloth/particle_elements.h"

#include <algorithm>

#include "cloth/bending_rows.h"
#include "geometry/at.h"

namespace cloth {

ParticleElements::ParticleElements(const ClothSystem& system)
    : springs_(system.springs),
      bending_(system.bending),
      sliders_(system.sliders),
      membrane_(system.membrane),
      rows_(system.rows),
      columns_(system.columns),
      is_mesh_(system.is_mesh()),
      size_(system.mass.size()) {}

bool ParticleElements::describe(const ClothSystem& system) const {
  return rows_ == system.rows && columns_ == system.columns && is_mesh_ == system.is_mesh() &&
         springs_ == system.springs && bending_ == system.bending && sliders_ == system.sliders &&
         membrane_ == system.membrane;
}

void ParticleElements::list() {
  if (is_listed_) return;
  list_springs();
  list_points();
  std::vector<int> colour_of;
  if (!is_mesh_) colour_of = colours_of_grid();
  if (is_mesh_ || !are_colours(colour_of)) colour_of = colours_in_order();
  for (std::size_t i = 0; i < size_; ++i) {
    if (at(colour_of[i]) >= colours_.size()) colours_.resize(at(colour_of[i]) + 1);
    colours_[at(colour_of[i])].push_back(static_cast<int>(i));
  }
  is_listed_ = true;
}

void ParticleElements::list_springs() {
  spring_ends_.assign(size_, [&](const auto& add) {
    for_each_spring(springs_, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
      if (!(run.stiffness > 0)) return;
      add(static_cast<int>(i), SpringEnd{static_cast<int>(j), run.rest_length, run.stiffness});
      add(static_cast<int>(j), SpringEnd{static_cast<int>(i), run.rest_length, run.stiffness});
    });
  });
}

void ParticleElements::list_points() {
  const BendingRows rows = bending_rows(bending_, bending_.empty() ? 0 : size_);
  bending_entries_.assign(size_, [&](const auto& add) {
    for (std::size_t i = 0; i + 1 < rows.begin.size(); ++i)
      for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k)
        add(static_cast<int>(i), BendingEntry{rows.column[k], rows.stiffness[k]});
  });
  slider_points_.assign(size_, [&](const auto& add) {
    for (std::size_t k = 0; k < sliders_.size(); ++k)
      for (int p = 0; p < sliders_[k].points; ++p)
        add(sliders_[k].particle[at(p)], ElementPoint{static_cast<int>(k), p});
  });
  corners_.assign(size_, [&](const auto& add) {
    for (std::size_t t = 0; t < membrane_.size(); ++t)
      for (int c = 0; c < 3; ++c) add(membrane_[t].corner[at(c)], ElementPoint{static_cast<int>(t), c});
  });
}

std::vector<int> ParticleElements::colours_of_grid() const {
  std::vector<int> colour_of(size_);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      colour_of[at(row * columns_ + column)] = (row + 2 * column) % 5;
  return colour_of;
}

/// visit(j) for every particle j that shares an element with another, that one too; some more than once.
template <class Visit>
void ParticleElements::for_each_neighbour(std::size_t particle, const Visit& visit) const {
  for (const SpringEnd& end : springs(particle)) visit(at(end.other));
  for (const BendingEntry& entry : bending(particle)) visit(at(entry.other));
  for (const ElementPoint& p : sliders(particle)) {
    const BendingSlider& slider = sliders_[at(p.element)];
    for (int q = 0; q < slider.points; ++q) visit(at(slider.particle[at(q)]));
  }
  for (const ElementPoint& p : triangles(particle))
    for (const int corner : membrane_[at(p.element)].corner) visit(at(corner));
}

bool ParticleElements::are_colours(const std::vector<int>& colour_of) const {
  bool differ = true;
  for (std::size_t i = 0; i < size_ && differ; ++i)
    for_each_neighbour(i, [&](std::size_t j) { differ &= j == i || colour_of[j] != colour_of[i]; });
  return differ;
}

std::vector<int> ParticleElements::colours_in_order() const {
  std::vector<int> colour_of(size_, -1);
  std::vector<std::size_t> taken_for;  // the last particle, counted from 1, that may not have this colour
  for (std::size_t i = 0; i < size_; ++i) {
    for_each_neighbour(i, [&](std::size_t j) {
      if (j == i || colour_of[j] < 0) return;
      if (at(colour_of[j]) >= taken_for.size()) taken_for.resize(at(colour_of[j]) + 1, 0);
      taken_for[at(colour_of[j])] = i + 1;
    });
    const auto free =
        std::find_if(taken_for.begin(), taken_for.end(), [&](std::size_t t) { return t != i + 1; });
    colour_of[i] = static_cast<int>(free - taken_for.begin());
  }
  return colour_of;
}

}  // namespace cloth
