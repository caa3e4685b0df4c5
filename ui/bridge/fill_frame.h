// Fills a ClothFrame from a simulation. Called on the worker's thread, so that the window's thread only
// draws.
#pragma once

#include <vector>

#include "bridge/frame.h"
#include "simulation/simulation.h"

namespace clothlab {

/// Fills all members except `topology`, which the worker counts, and `shows_difference`. `state` may be an
/// earlier state of the simulation. `normals` is scratch memory. Does not allocate while the size of the
/// cloth stays the same.
void fill_frame(const cloth::Simulation& simulation, const cloth::ClothState& state,
                cloth::Vec3Field& normals, ClothFrame& frame);

/// Stores the distances from a reference (m, one for each particle) in `frame.strain`; empty: no distance is
/// known.
void show_difference(const std::vector<float>& distance, ClothFrame& frame);

/// Fills the part of a frame that shows contact.
class ContactFiller {
 public:
  /// Fills `frame.contact` from the simulation's present state. Allocates only when there is more to show
  /// than in any earlier frame.
  void fill(cloth::Simulation& simulation, const ContactChoice& choice, ClothFrame& frame);

 private:
  void fill_marks(const cloth::Simulation& simulation, ContactPicture& picture);
  void fill_boxes(cloth::Simulation& simulation, int obstacle, int level, ContactPicture& picture);

  std::vector<cloth::ContactMark> marks_;
  std::vector<cloth::Bounds> boxes_;
};

}  // namespace clothlab
