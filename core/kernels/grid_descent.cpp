#include "kernels/grid_descent.h"

#include <algorithm>
#include <cmath>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int residues = 5, widest = kernels::widest_vector;

}  // namespace

bool GridDescent::suits(const kernels::Grid& grid) {
  return std::all_of(std::begin(grid.kind), std::end(grid.kind),
                     [](const auto& kind) { return std::isfinite(kind.rest_tension); });
}

GridDescent::GridDescent(const kernels::Grid& grid) : kernels_(&active_kernels<kernels::GridKernels>()) {
  descent_.grid = grid;
  for (int k = 0; k < kernels::spring_kinds; ++k)
    if (grid.kind[k].stiffness > 0)
      descent_.rest_length[k] = grid.kind[k].rest_tension / grid.kind[k].stiffness;
  const int longest = (grid.columns + residues - 1) / residues;
  descent_.residue_stride = (longest + widest - 1) / widest * widest + widest;
  descent_.row_stride = residues * descent_.residue_stride;
  if (descent_.row_stride % 512 == 0) descent_.row_stride += widest;  // rows not all in one place of a cache
  descent_.first = widest;

  there_.assign(static_cast<std::size_t>(descent_.row_stride + 2 * widest), 0.0);
  for (int column = 0; column < grid.columns; ++column)
    there_[static_cast<std::size_t>(descent_.first + column % residues * descent_.residue_stride +
                                    column / residues)] = 1;
  descent_.there = there_.data() + descent_.first;
  std::vector<int> place_of;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      place_of.push_back(static_cast<int>(descent_.place(row, column % residues, column / residues)));
  make_room(std::move(place_of), static_cast<int>(descent_.place(grid.rows, 0, 0)) + widest, descent_);
}

}  // namespace cloth
