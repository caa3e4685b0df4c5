// The springs of a general mesh, arranged once so that they can be evaluated side by side and by several
// threads.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/mesh_kernel.h"

namespace cloth {

/// Eight particles in a row make a slice, and each of its lanes is one particle. Every spring belongs to one
/// of its ends, chosen so that the particles of a slice own about the same number; spring number t of each
/// lane makes up the slice's slot t (sliced ELLPACK: Kreutzer et al. 2014). A lane without a spring left is
/// its own neighbour, with stiffness 0.
///
/// Slices in a row make a block. Two blocks of one colour touch no particle in common, so the blocks of a
/// colour can be evaluated by as many threads as there are, and colour after colour the sum on every particle
/// is taken in one order. One thread alone takes the blocks in a sequence that leaves this order as it is,
/// but stays in one neighbourhood. All this depends on the system alone.
struct MeshLayout {
  struct alignas(64) Numbers {
    double lane[slice_width];
  };
  struct alignas(32) Indices {
    int lane[slice_width];
  };
  struct Block {
    int begin = 0, end = 0;  ///< slices
  };

  int particles = 0, slices = 0;
  std::vector<int> slot_begin;
  std::vector<Indices> neighbour;  ///< 4 times its number, as it stands in MeshArrays

  std::vector<Numbers> stiffness, tension;
  std::vector<std::vector<Block>> colours;
  std::vector<Block> sequence;               ///< for one thread
  std::vector<int> load_until, store_until;  ///< of MeshSweep, along the sequence
};

/// Particles should be numbered with a small bandwidth (cloth/mesh_order.h): the further springs reach, the
/// more colours, and the less fits into the caches.
MeshLayout make_mesh_layout(const ClothSystem& system);

/// For each block the others that touch a particle that it touches; `touched` holds the particles of each
/// block.
std::vector<std::vector<int>> blocks_that_meet(const std::vector<std::vector<int>>& touched, int particles);

/// A colour for each block such that no two blocks of one colour meet. Greedy: block by block the lowest that
/// is free.
std::vector<int> colours_of_blocks(const std::vector<std::vector<int>>& meeting);

}  // namespace cloth
