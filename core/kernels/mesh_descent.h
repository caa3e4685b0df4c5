// VBD's visits of any cloth (coloured_descent.h). The particles of a colour come one after the other, sorted
// by how many elements they have, so that few lanes are empty, and filled up to whole slices of eight.
#pragma once

#include "cloth/particle_elements.h"
#include "kernels/particle_descent.h"

namespace cloth {

class MeshDescent : public ParticleDescent {
 public:
  /// `elements`: of `system`, listed. Precondition: suits(system.springs).
  MeshDescent(const ClothSystem& system, const ParticleElements& elements);
  /// Whether no spring is rigid.
  static bool suits(const SpringRuns& springs);
  bool takes_elements() const override { return true; }

 private:
  struct Bending {
    std::vector<int> begin, neighbour;
    AlignedDoubles coupling, own, held[3];
  };
  struct Triangles {
    std::vector<int> begin, next, before;
    AlignedDoubles numbers;
  };
  struct Sliders {
    std::vector<int> begin, points, neighbour;
    std::vector<int> element;  ///< [slot][lane]: the slider there, or -1
    AlignedDoubles coefficient, numbers;
  };

  void place_particles(const ParticleElements& elements);
  void make_springs(const ParticleElements& elements);
  void make_bending(const ParticleElements& elements);
  void make_triangles(const ClothSystem& system, const ParticleElements& elements);
  void make_sliders(const ClothSystem& system, const ParticleElements& elements);
  void hold_bending(double time);
  void set_sliders(const SliderState& state);
  void begin_visits(const Start& start) override;
  void visit_all() override { local_kernels().descend(descent_); }
  void positions_have_moved() override;

  kernels::ColouredDescent descent_;
  std::vector<int> particle_at_;  ///< of each place, -1 of padding
  std::vector<int> slot_begin_, neighbour_;
  AlignedDoubles stiffness_, rest_length_, vectors_, start_vectors_;
  Bending bending_;
  Triangles triangles_;
  Sliders sliders_;
};

}  // namespace cloth
