// The constant matrix A = M + h D_max + h^2 L of projective dynamics (integrators/projective.h), and what
// solves with it: sparse Cholesky factors, or on a grid one cycle of multigrid, where that is cheaper and
// reduces the error enough. A cycle reduces every error in the norm of A, so that an iteration with it lowers
// the incremental potential as well; the limit is the same.
#pragma once

#include "integrators/implicit/linear_solver.h"
#include "sparse/grid_multigrid.h"

namespace cloth {

class ProjectiveMatrix {
 public:
  /// What A consists of beside springs, bending, masses and pins. Units as in NodeDamping.
  struct Coefficients {
    double step = 0;  ///< s
    NodeCoefficient node_damping;
    double spring_damping = 0, stretch_time = 0, bending_time = 0, membrane_time = 0;
    int held_particle = -1;
    double held_damping = 0, held_stiffness = 0;
    bool operator==(const Coefficients&) const = default;
  };

  /// Fewest particles, and largest factor by which a cycle may leave an error, with which a grid is solved by
  /// multigrid.
  static constexpr std::size_t fewest_particles = 400;
  static constexpr double largest_factor = 0.5;

  /// Makes what solves; nothing is done where the matrix is that of the last call. Returns how often
  /// something was made. `*usable`: whether the matrix is positive definite.
  int prepare(const ClothSystem& system, const Coefficients& numbers, bool* usable);

  /// correction = A^-1 residual, or approximately so (N s, m/s). Zero on pins.
  void solve(const Vec3Field& residual, Vec3Field& correction);

  bool uses_multigrid() const { return cycles_; }
  /// By which a cycle reduces an error at last; none where no cycle was tried.
  std::optional<double> cycle_factor() const { return factor_; }

 private:
  bool is_of(const ClothSystem& system, const Coefficients& numbers) const;
  bool has_pattern_of(const ClothSystem& system) const;
  bool prepare_cycles();
  bool factorise(bool same_pattern, const ClothSystem& system);
  template <class Add, class Couple>
  void for_each_number(Add add, Couple couple) const;

  bool usable_ = false, cycles_ = false, analysed_ = false;
  std::optional<double> factor_;
  Coefficients coefficients_;
  int grid_rows_ = 0, grid_columns_ = 0;  ///< 0: no grid
  SpringRuns springs_;
  BendingRuns bending_;
  BendingRows bending_rows_;  ///< of these
  Membrane membrane_;
  BendingSliders sliders_;
  std::vector<double> mass_;
  std::vector<std::uint8_t> pinned_;
  GridMultigrid multigrid_;
  FreeRows rows_;
  BlockCholesky factors_{1};
  std::vector<double> values_;  ///< of the free particles: x, y, z one after the other
};

}  // namespace cloth
