// Aggregates of smoothed aggregation (Vanek, Mandel and Brezina 1996): the points of a graph in groups of
// neighbours, each of which becomes one point of the next coarser level.
#pragma once

#include "sparse/sparse_pattern.h"

namespace cloth {

struct Aggregates {
  std::vector<int> of;    ///< each point's; -1 where a point has no neighbour
  SparsePattern members;  ///< the points of each
  int count() const { return members.rows(); }
};

/// `graph`: a symmetric pattern, whose diagonal says nothing. First points whose neighbours are all free are
/// taken together with them, in the order of their numbers; what is left joins a neighbour's aggregate.
Aggregates aggregate(const SparsePattern& graph);

/// The graph of the aggregates: neighbours are those that an edge joins.
SparsePattern graph_of(const Aggregates& aggregates, const SparsePattern& graph);

/// Point by point what of its aggregate's rigid motions its vector takes part in: an orthonormal basis of the
/// modes on each aggregate (Vanek, Mandel and Brezina 1996, Algorithm 2).
///
/// `modes`: of each point `block` x 6 numbers, row by row. `basis` gets as many, zero where a point has no
/// aggregate, and columns of zeros where modes are not independent there. `coarse` gets 6 x 6 for each
/// aggregate: modes = basis coarse.
void orthonormalise(const Aggregates& aggregates, std::size_t block, const std::vector<double>& modes,
                    std::vector<double>& basis, std::vector<double>& coarse);

}  // namespace cloth
