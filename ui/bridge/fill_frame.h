// A frame from a simulation: everything that a picture needs and that the window's thread need not compute.
#pragma once

#include <vector>

#include "bridge/frame.h"
#include "simulation/simulation.h"

namespace clothlab {

/// All but `topology`, which the worker counts, and `shows_difference`. The state may be an earlier one of
/// the simulation. `normals` is scratch. Neither allocates when the cloth has the size of the last time.
void fill_frame(const cloth::Simulation& simulation, const cloth::ClothState& state,
                cloth::Vec3Field& normals, ClothFrame& frame);
void fill_frame(const cloth::Simulation& simulation, cloth::Vec3Field& normals, ClothFrame& frame);

/// Colours the frame by these distances from a reference in m, one of each particle; empty: there are none.
void show_difference(const std::vector<float>& distance, ClothFrame& frame);

/// What a frame tells of contact, for those who want to see it.
class ContactFiller {
 public:
  /// Fills `frame.contact` from the simulation's present state. Allocates nothing once it has been as much.
  void fill(cloth::Simulation& simulation, const ContactChoice& choice, ClothFrame& frame);

 private:
  void fill_marks(const cloth::Simulation& simulation, ContactPicture& picture);
  void fill_boxes(cloth::Simulation& simulation, int obstacle, int level, ContactPicture& picture);

  std::vector<cloth::ContactMark> marks_;
  std::vector<cloth::Bounds> boxes_;
};

}  // namespace clothlab
