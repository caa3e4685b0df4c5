// What acts on each particle of a cloth, for methods that solve for one particle at a time
// (integrators/vbd.h), and the order in which they visit the particles: by colours, of which no two particles
// of one share an element.
//
// On a grid whose elements reach no further than two particles along its lines or one across them (springs
// and the bending of a material on grids do not) the colour of (row, column) is (row + 2 column) mod 5. On
// other cloths particles take, in their order, the first colour that none of those has with which they share
// an element. Within a colour the order is that of the particles.
#pragma once

#include <span>
#include <vector>

#include "cloth/cloth_system.h"

namespace cloth {

/// A spring of positive stiffness, seen from one of its ends.
struct SpringEnd {
  int other = 0;
  double rest_length = 0, stiffness = 0;  ///< m, N/m
};

/// What bending couples a particle with: an entry of its row (cloth/bending_rows.h).
struct BendingEntry {
  int other = 0;
  double stiffness = 0;  ///< K_ij, N/m
};

/// A point of a slider or a triangle, of the element numbered so.
struct ElementPoint {
  int element = 0, point = 0;
};

/// A list for each particle, one after the other.
template <class Entry>
class ListsOfParticles {
 public:
  std::span<const Entry> of(std::size_t particle) const {
    return {entries_.data() + first_[particle], first_[particle + 1] - first_[particle]};
  }

  /// fill(add) calls add(particle, entry); it is called twice and must do the same. Lists keep that order.
  template <class Fill>
  void assign(std::size_t particles, const Fill& fill) {
    first_.assign(particles + 1, 0);
    fill([&](int particle, const Entry&) { ++first_[static_cast<std::size_t>(particle) + 1]; });
    for (std::size_t i = 0; i < particles; ++i) first_[i + 1] += first_[i];
    entries_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    fill([&](int particle, const Entry& entry) {
      entries_[next[static_cast<std::size_t>(particle)]++] = entry;
    });
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<Entry> entries_;
};

class ParticleElements {
 public:
  ParticleElements() = default;
  explicit ParticleElements(const ClothSystem& system);
  /// Whether these are the elements of `system`, as it is now.
  bool describe(const ClothSystem& system) const;

  /// Makes the lists and colours, if that has not been done; all that follows needs them.
  void list();

  std::span<const SpringEnd> springs(std::size_t particle) const { return spring_ends_.of(particle); }
  std::span<const BendingEntry> bending(std::size_t particle) const { return bending_entries_.of(particle); }
  std::span<const ElementPoint> sliders(std::size_t particle) const { return slider_points_.of(particle); }
  std::span<const ElementPoint> triangles(std::size_t particle) const { return corners_.of(particle); }

  /// The particles of each colour.
  const std::vector<std::vector<int>>& colours() const { return colours_; }

 private:
  void list_springs();
  void list_points();
  template <class Visit>
  void for_each_neighbour(std::size_t particle, const Visit& visit) const;
  bool are_colours(const std::vector<int>& colour_of) const;
  std::vector<int> colours_of_grid() const;
  std::vector<int> colours_in_order() const;

  SpringRuns springs_;
  BendingRuns bending_;
  BendingSliders sliders_;
  Membrane membrane_;
  int rows_ = 0, columns_ = 0;
  bool is_mesh_ = false, is_listed_ = false;
  std::size_t size_ = 0;
  ListsOfParticles<SpringEnd> spring_ends_;
  ListsOfParticles<BendingEntry> bending_entries_;
  ListsOfParticles<ElementPoint> slider_points_, corners_;
  std::vector<std::vector<int>> colours_;
};

}  // namespace cloth
