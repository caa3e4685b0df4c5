// The springs of a general mesh, arranged once so that the forces on eight particles are summed in SIMD
// lanes.
#pragma once

#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "cloth/mesh_order.h"
#include "kernels/mesh_pass.h"

namespace cloth {

/// Eight particles in a row make a slice, and each of its lanes is one particle; spring number t of each lane
/// makes up the slice's slot t (sliced ELLPACK: Kreutzer et al. 2014). Every spring stands at both of its
/// ends, and those of a particle in the order of their other ends. All this depends on the system alone.
struct MeshLayout {
  struct alignas(64) Numbers {
    double lane[kernels::slice_width];
  };
  struct alignas(32) Indices {
    int lane[kernels::slice_width];
  };
  struct alignas(8) Kinds {
    unsigned char lane[kernels::slice_width];
  };

  int particles = 0, slices = 0, blocks = 0;
  ParticleOrder order;  ///< the particle of each lane, slice after slice; empty: as the system numbers them
  std::vector<int> slot_begin;
  std::vector<Indices> neighbour;           ///< as in kernels::MeshSlots, and so are all of these
  std::vector<Kinds> kind;                  ///< empty where no table is used
  std::vector<Numbers> stiffness, tension;  ///< empty where a table is used
  std::array<double, kernels::max_kinds> stiffness_of_kind{}, tension_of_kind{};
  std::vector<int> load_until;  ///< by block

  kernels::MeshSlots slots() const;
};

/// Takes the particles as the system numbers them where that serves, else in an order of its own.
MeshLayout make_mesh_layout(const ClothSystem& system);

/// Whether the springs of a system are mostly runs too short for the kernels of a grid.
bool suits_mesh_layout(const ClothSystem& system);

}  // namespace cloth
