// A linear system as Newton's method meets it in a step of implicit Euler: a hanging cloth of springs, 1/60
// s.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "forces/linearisation.h"

namespace cloth::solvers {

/// `smooth`: a sheet pinned along its upper edge that swings down. `buckled`: one that hangs by two corners
/// which are 15 % nearer to each other than the sheet is wide, just after it began to buckle. `mesh`: the
/// first in irregular triangles.
enum class ClothShape { smooth, buckled, mesh };
inline constexpr const char* cloth_shape_names[] = {"smooth", "buckled", "mesh, smooth"};
inline constexpr ClothShape cloth_shapes[] = {ClothShape::smooth, ClothShape::buckled, ClothShape::mesh};

struct NewtonSystem {
  ClothSystem system;
  Linearisation matrix;        ///< A: exact, or clamped where that is not positive definite
  Linearisation clamped;       ///< what multigrid is made from; equal to A where no spring is compressed
  Vec3Field position;          ///< m, where it was linearised
  Vec3Field right_hand_side;   ///< N s, 0 on pins
  int iteration = 0;           ///< of Newton's method in its step
  bool is_exact = true;        ///< A is the exact Jacobian
  double compressed_part = 0;  ///< of all springs that are shorter than at rest

  /// |b - A x| / |b| over the free particles
  double relative_residual(const Vec3Field& solution) const;
};

/// The fourth iteration's system, or the last one's where it converged before. 1000 N/m structural, 500
/// shear (of a grid), 100 flexion, 0.25 kg, 1 m x 1 m.
std::unique_ptr<NewtonSystem> newton_system(ClothShape shape, int size);

/// All of a symmetric matrix, row by row, columns ascending; row 3 k + c is component c of free particle k.
struct SparseRows {
  std::vector<int> begin;   ///< of each row in `column`, and the end of the last
  std::vector<int> column;  ///< of each number
  std::vector<double> value;
  std::vector<int> particle;  ///< of each three rows
  int rows() const { return static_cast<int>(begin.size()) - 1; }
};

/// Where each 3x3 block of a linearisation goes in a SparseRows, found once for a pattern.
class RowPattern {
 public:
  explicit RowPattern(const ClothSystem& system);
  const SparseRows& rows() const { return rows_; }
  /// Writes A's numbers into the rows.
  const SparseRows& fill(const ClothSystem& system, const Linearisation& matrix);

 private:
  struct Place {
    std::size_t begin[3];  ///< of the block's three numbers in each of its rows, in `value`
  };
  void put(const Place& place, double scale, const SymmetricBlock& block);

  std::vector<int> row_;              ///< of each particle; -1 where pinned
  std::vector<Place> diagonal_;       ///< of each free particle
  std::vector<Place> upper_, lower_;  ///< of each spring between free particles
  SparseRows rows_;
};

/// The three components of every free particle one after the other, and back.
std::vector<double> packed(const SparseRows& rows, const Vec3Field& field);
void unpack(const SparseRows& rows, const std::vector<double>& values, Vec3Field& field);

}  // namespace cloth::solvers
