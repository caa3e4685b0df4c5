// The elimination order of the unknowns of a sparse symmetric matrix determines the fill of its Cholesky
// factors. On a grid nested dissection (George 1973) is optimal up to a constant: a separator, lines of
// particles that no spring crosses, is eliminated last, and the two halves are ordered likewise. Lines may
// also be diagonals: no spring of a cloth crosses two neighbouring ones, and a diagonal has fewer particles
// for its length than a row.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "cloth/cloth_system.h"

namespace cloth {

/// An unordered pair of unknowns with a nonzero block off the diagonal.
using Coupling = std::pair<int, int>;

/// The largest extent of a coupling in rows, columns, row + column, and row - column: the width of a
/// separator of lines along which that number is constant.
struct GridReach {
  std::array<int, 4> along{};
};

/// The furthest reach among the springs and bending elements of a grid.
GridReach reach_of(const ClothSystem& system);

/// The given particles of a grid, numbered row by row, in the order of elimination.
std::vector<int> nested_dissection(const std::vector<int>& particles, int columns, const GridReach& reach);

/// The unknowns 0..size of any pattern: approximate minimum degree (Amestoy et al. 1996). Couplings may
/// repeat.
std::vector<int> minimum_degree(int size, const std::vector<Coupling>& couplings);

/// The free particles of a cloth in the order of elimination for matrices that have a block where a spring
/// or a bending element joins two: nested dissection where springs reach no further than a grid's, minimum
/// degree elsewhere.
std::vector<int> elimination_order(const ClothSystem& system);

}  // namespace cloth
