// The matrix of an implicit step (forces/linearisation.h) as 3x3 blocks of the free particles, in the order
// in which solvers of any pattern take them: one for each of them, and one for each coupling.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "forces/linearisation.h"
#include "sparse/block_cholesky.h"

namespace cloth {

/// The rows of a matrix with one block row for each free particle, and one block off the diagonal for each
/// spring, and each pair of for_each_element_pair(), between two of them.
struct FreeRows {
  std::vector<int> row;             ///< of each particle; -1 where pinned
  std::vector<int> particle;        ///< of each row
  std::vector<Coupling> couplings;  ///< springs and pairs between free particles, by their rows
};
FreeRows free_rows(const ClothSystem& system);

/// Has `factors` analyse the pattern of these rows.
void analyse_free_rows(const ClothSystem& system, const FreeRows& rows, BlockCholesky& factors);

class FreeBlocks {
 public:
  /// Finds the pattern, and returns true, where it is not that of the last call: when springs, other elements
  /// or pins have changed.
  bool analyse(const ClothSystem& system);
  /// Takes the numbers of A.
  void gather(const ClothSystem& system, const Linearisation& linearisation);

  const FreeRows& rows() const { return rows_; }
  std::span<const double> diagonal() const { return diagonal_; }          ///< 9 for each row
  std::span<const double> off_diagonal() const { return off_diagonal_; }  ///< 9 for each coupling

  /// Three numbers for each row, and back; zero on pins.
  void pack(const Vec3Field& field, std::vector<double>& numbers) const;
  void unpack(const std::vector<double>& numbers, Vec3Field& field) const;

 private:
  bool fits(const ClothSystem& system) const;

  std::vector<std::uint8_t> pinned_;  ///< that the pattern was made for
  SpringRuns runs_;                   ///< of the springs that were analysed
  BendingRuns bending_;
  Membrane membrane_;
  BendingSliders sliders_;
  FreeRows rows_;
  std::vector<double> diagonal_, off_diagonal_;
};

}  // namespace cloth
