// The second derivative K of the bending energy (cloth/bending.h) by its rows: a product with it costs a
// third of that over the elements where these do not lie in runs, as on a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/bending.h"

namespace cloth {

/// Row i holds K_ij, N/m, of each j but i, whose own is minus their sum: no product comes from moving all
/// alike.
struct BendingRows {
  std::vector<std::uint32_t> begin;  ///< of each row and behind the last; empty: there are no rows
  std::vector<std::int32_t> column;  ///< j, ascending
  std::vector<double> stiffness;     ///< K_ij
};

BendingRows bending_rows(const BendingRuns& runs, std::size_t particles);

/// result += scale * K field.
void add_bending_product(const BendingRows& rows, double scale, const Vec3Field& field, Vec3Field& result);

struct ClothSystem;
/// By the system's rows where it has some, else by its runs.
void add_bending_product(const ClothSystem& system, double scale, const Vec3Field& field, Vec3Field& result);

}  // namespace cloth
