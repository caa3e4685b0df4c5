// Sparse Cholesky factorisation of a symmetric, positive definite matrix of small square blocks by the
// multifrontal method (Duff and Reid 1983; Liu 1992): every front assembles its columns of the matrix and the
// updates of its children, is factored densely, and produces an update for its parent. The pattern is
// analysed once.
//
//     BlockCholesky factors(3);
//     factors.analyse(couplings, order);            // once for a pattern
//     if (factors.factorise(diagonal, coupling_blocks))
//       factors.solve(values, 1);
#pragma once

#include <span>

#include "sparse/dense_kernels.h"
#include "sparse/elimination_tree.h"

namespace cloth {

class BlockCholesky {
 public:
  /// `block`: rows of a block.
  explicit BlockCholesky(int block) : block_(static_cast<std::size_t>(block)) {}

  /// `couplings`: the unknowns, numbered as in `order`, that have a block off the diagonal. They may repeat.
  void analyse(const std::vector<Coupling>& couplings, const std::vector<int>& order);

  /// Of every unknown the block on the diagonal, of every coupling the one in the row of its first and the
  /// column of its second unknown; block x block numbers each, column by column. Those that repeat are added.
  /// False where the matrix is not positive
  /// definite; nothing can then be solved.
  bool factorise(std::span<const double> diagonal, std::span<const double> coupling_blocks);

  /// values <- A^-1 values. Up to four right-hand sides, one after the other, each block numbers per unknown.
  void solve(std::span<double> values, int columns);

  double operations() const { return operations_; }  ///< multiplications of one factorisation

 private:
  /// A block of the matrix and where it goes within its front's panel.
  struct Entry {
    std::size_t source, target;
    bool transposed;
  };
  /// Where a front's columns are kept, and where its update goes within the parent's front.
  struct Panel {
    std::size_t begin = 0;
    std::size_t first_entry = 0, end_entry = 0;
    std::vector<int> in_parent;  ///< of each of the front's rows, in blocks
    std::vector<int> children;
  };

  void place_entries(const std::vector<Coupling>& couplings);
  void plan_memory();
  void gather(std::size_t front, std::span<const double> diagonal, std::span<const double> coupling_blocks,
              double* columns) const;
  void add_update(std::size_t child, const double* from, double* columns, double* update) const;
  template <class Number>
  void solve_ordered(Number* x, std::vector<Number>& below);

  std::size_t block_;
  EliminationTree tree_;
  std::vector<std::size_t> unknown_at_;  ///< each place in the order of elimination
  std::vector<Panel> panels_;            ///< of each front
  std::vector<Entry> entries_;           ///< front by front: couplings
  std::vector<double> factors_;          ///< the fronts' own columns
  std::vector<double> updates_;          ///< a stack
  std::size_t tallest_ = 0;              ///< update of a front, in numbers
  std::vector<double> ordered_, below_;  ///< scratch of solve
  std::vector<Quad> ordered_quads_, below_quads_;
  double operations_ = 0;
};

}  // namespace cloth
