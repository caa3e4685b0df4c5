// The springs of a general mesh, arranged once for each system so that a kernel sums the forces on eight
// particles in SIMD lanes.
#pragma once

#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "cloth/mesh_order.h"
#include "kernels/mesh_pass.h"

namespace cloth {

/// Sliced ELLPACK (Kreutzer et al. 2014): eight consecutive particles are a slice, one in each lane, and slot
/// t of a slice holds the t-th spring of each of its particles. Every spring is stored at both its ends; the
/// springs of a particle are in the order of their other ends. The layout depends on the system alone.
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
  ParticleOrder order;  ///< the particle in each lane, slice after slice; empty: the system's order
  std::vector<int> slot_begin;
  std::vector<Indices> neighbour;           ///< this and the following as in kernels::MeshSlots
  std::vector<Kinds> kind;                  ///< empty where no table is used
  std::vector<Numbers> stiffness, tension;  ///< empty where a table is used
  std::array<double, kernels::max_kinds> stiffness_of_kind{}, tension_of_kind{};
  std::vector<int> load_until;  ///< see kernels::MeshPass

  kernels::MeshSlots slots() const;
};

/// Keeps the system's order of particles where that serves the cache; otherwise renumbers them
/// (cloth/mesh_order.h).
MeshLayout make_mesh_layout(const ClothSystem& system);

/// Whether most springs of a system are in runs of constant offset too short for the kernels of a grid.
bool suits_mesh_layout(const ClothSystem& system);

}  // namespace cloth
