// The order in which a sweep visits the limited springs: batches (colours) of springs of which no two share a
// particle, so that a batch may be done all at once, with the same result in any order within it.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"
#include "limiter/sweep_kernels.h"

namespace cloth {

enum class FreeEnds { both, first, second };

struct SpringBatch {
  SpringRow row;
  FreeEnds ends = FreeEnds::both;
  double limit = 0;        ///< m, (1 + rate) times the rest length
  double rest_length = 0;  ///< m
  int low = 0, high = 0;   ///< rows of particles that the springs end in, from `low` to `high`
};

/// The runs cut where a row of particles ends and where other ends are free, in their order; every piece has
/// a stride of 1. Springs between two pins are left out: they are not the limiter's to change.
std::vector<SpringBatch> pieces_of(const ClothSystem& system, const std::vector<SpringRun>& runs,
                                   double rate);

/// The pieces divided into independent springs: those between neighbours into every other one and the rest,
/// longer ones into stretches no longer than their offset, which on a grid are whole rows.
std::vector<SpringBatch> batches_of(const std::vector<SpringBatch>& pieces, int columns);

/// Row by row of the first particle, so that a row's particles are in the cache for all its springs.
std::vector<SpringBatch> row_by_row(std::vector<SpringBatch> pieces);

}  // namespace cloth
