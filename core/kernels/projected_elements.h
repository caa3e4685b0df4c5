// The elements of a cloth beside springs in the order in which XPBD visits them by the kernels
// (element_visits.h): bending, then sliders, then triangles.
//
// Bending elements and sliders are taken 256 at a time in their order, and of these one colour after the
// other; triangles are coloured as a whole, and those of a colour visited eight at a time. An element takes
// the first colour that none has with which it shares a particle. The order depends on the system alone.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"
#include "geometry/aligned.h"
#include "kernels/local_pass.h"

namespace cloth {

class ProjectedElements {
 public:
  ProjectedElements() = default;
  explicit ProjectedElements(const ClothSystem& system);
  /// Whether these are the elements of `system`, as it is now.
  bool describe(const ClothSystem& system) const {
    return bending_ == system.bending && sliders_ == system.sliders && membrane_ == system.membrane;
  }
  bool is_empty() const { return bending_.empty() && sliders_.empty() && membrane_.empty(); }
  /// Whether the stiffness of every triangle is positive semidefinite, which its visit takes for granted.
  bool suits_kernels() const { return suits_; }

  struct Times {
    double bending = 0, membrane = 0;  ///< s, of damping
  };
  /// Steps follow in which particles answer by `mobility` (1/kg), w of each, 0 where pinned.
  void begin(const Times& times, const std::vector<double>& mobility);
  /// A step of which nothing is visited yet. `sliders`: of the system's, or null: they are left out.
  void begin_step(const SliderState* sliders);
  /// Visits every element once.
  void visit(kernels::ProjectedParticles& particles);

 private:
  /// Elements in the order of visits.
  struct Sums {
    std::vector<int> element, begin, particle;
    std::vector<double> coefficient, stiffness, give;
    AlignedDoubles impulse;  ///< 4-vectors

    void set_give(const std::vector<double>& mobility);
    void clear_impulses() { impulse.assign(4 * element.size(), 0.0); }
    void hand_to(kernels::SumElements& elements);
  };
  void make_bending(const ClothSystem& system);
  void make_sliders(const ClothSystem& system);
  void make_triangles(const ClothSystem& system);

  BendingRuns bending_;
  BendingSliders sliders_;
  Membrane membrane_;
  bool suits_ = true;
  Sums bends_, slides_;
  std::vector<double> slip_, most_;
  AlignedDoubles normal_;      ///< 4-vectors
  std::vector<int> triangle_;  ///< [block][lane], -1: none
  std::vector<int> corner_;
  AlignedDoubles numbers_, impulse_;
  kernels::ElementProjection pass_;
  const kernels::LocalKernels* kernels_ = nullptr;
};

}  // namespace cloth
