// Numberings of the particles of a general mesh with a small bandwidth, so that the ends of a spring are
// close in memory and few particles are shared between threads.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"

namespace cloth {

/// order[k]: the present number of the particle that becomes number k.
using ParticleOrder = std::vector<int>;

/// Reverse Cuthill-McKee (Cuthill and McKee 1969, George 1971), each connected part from an end of a long
/// path through it (George and Liu 1979).
ParticleOrder small_bandwidth_order(const ClothSystem& system);

/// The same, then sorted by the number of springs within every 64 consecutive particles, so that neighbours
/// in the numbering have equally many (the sorting windows of Kreutzer et al. 2014).
ParticleOrder order_for_sweeps(const ClothSystem& system);

/// The order that undoes `order`.
ParticleOrder inverse_of(const ParticleOrder& order);

/// The largest difference between the numbers of a spring's ends.
int bandwidth_of(const ClothSystem& system);

}  // namespace cloth
