// VBD's visits of any cloth of springs (coloured_descent.h). The particles of a colour come one after the
// other, sorted by how many springs they have, so that few lanes are empty, and filled up to whole slices of
// eight.
#pragma once

#include "kernels/particle_descent.h"

namespace cloth {

class MeshDescent : public ParticleDescent {
 public:
  /// `colours`: the particles of each; no two of one share a spring. Precondition: suits(springs).
  MeshDescent(const SpringRuns& springs, const std::vector<std::vector<int>>& colours, std::size_t particles);
  /// Whether no spring is rigid.
  static bool suits(const SpringRuns& springs);
  bool takes_stretch_time() const override { return true; }

 private:
  void make_slots(const SpringRuns& springs, const std::vector<int>& particle_at);
  void begin_visits(const Start& start) override;
  void visit_all() override { local_kernels().descend(descent_); }
  void positions_have_moved() override;

  kernels::ColouredDescent descent_;
  std::vector<int> slot_begin_, neighbour_;
  AlignedDoubles stiffness_, rest_length_, vectors_, start_vectors_;
};

}  // namespace cloth
