// What a frame tells of contact, for those who want to see it.
#pragma once

#include <vector>

#include "bridge/frame.h"
#include "simulation/simulation.h"

namespace clothlab {

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
