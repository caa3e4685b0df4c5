// The order in which a sweep of the deformation limiter visits the limited springs: in batches (a graph
// colouring). No two springs of a batch share a particle, so that its springs can be processed in SIMD lanes
// and on several threads with the same result as one by one.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"
#include "limiter/sweep_kernels.h"

namespace cloth {

/// Which ends of a spring are not pinned.
enum class FreeEnds { both, first, second };

/// Springs with common ends, limit and rest length.
struct SpringBatch {
  SpringRow row;
  FreeEnds ends = FreeEnds::both;
  double limit = 0;        ///< m, (1 + rate) times the rest length
  double rest_length = 0;  ///< m
  int low = 0, high = 0;   ///< first and last row of the springs' particles
};

/// The runs of springs (cloth/spring_runs.h) in their order, divided into pieces at the ends of rows and
/// where FreeEnds changes; the springs of a piece are consecutive. Springs between two pins are left out,
/// because the limiter cannot change them.
std::vector<SpringBatch> pieces_of(const ClothSystem& system, const std::vector<SpringRun>& runs,
                                   double rate);

/// The pieces divided into independent springs: those between neighbours into even and odd ones, longer ones
/// into index ranges of at most their offset, which on a grid are whole rows.
std::vector<SpringBatch> batches_of(const std::vector<SpringBatch>& pieces, int columns);

/// Row by row of the first particle, so that a row's particles are in the cache for all its springs.
std::vector<SpringBatch> row_by_row(std::vector<SpringBatch> pieces);

}  // namespace cloth
