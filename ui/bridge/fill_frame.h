// A frame from a simulation: everything that a picture needs and that the window's thread need not compute.
#pragma once

#include "bridge/frame.h"
#include "simulation/simulation.h"

namespace clothlab {

/// All but `topology`, which the worker counts. `normals` is scratch. Neither allocates when the cloth has
/// the size of the last time.
void fill_frame(const cloth::Simulation& simulation, cloth::Vec3Field& normals, ClothFrame& frame);

}  // namespace clothlab
