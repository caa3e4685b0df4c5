// TensionRounds for grids: SIMD lanes process neighbouring lines of springs of one direction together. Only
// the active rows are computed: from the first to the last row that has a spring over its limit or under
// tension.
#pragma once

#include <array>

#include "limiter/line_preconditioner.h"
#include "limiter/tension_rounds.h"

namespace cloth {

class GridRounds : public TensionRounds {
 public:
  explicit GridRounds(const GridPlan& plan);

  void begin(const TensionTask& task, const TensionProblem& problem) override;
  TensionResidual evaluate() override;
  void sweep_lines(bool backwards) override;
  int solve_together() override;
  void end(bool changed) override;

 private:
  using Values = AlignedFloats FamilyEquations::*;

  SpringRule rule_of(const FamilyEquations& family) const;
  GridNodes nodes();
  bool is_active(const FamilyEquations& family, int row) const;
  void take_weights(const std::vector<double>& inverse_mass);
  void evaluate_row(FamilyEquations& family, int row);
  void measure_row(FamilyEquations& family, int row);
  void sweep_rows(FamilyEquations& family);
  void sweep_columns(FamilyEquations& family);
  void sweep(const LineBlock& block, const FamilyEquations& family);
  void find_equations();
  int springs_at(int row, Values value, SpringTerm* terms) const;
  double multiply(Values value, double ridge);
  double advance(double length);
  int conjugate_gradients();
  void take_step();
  template <class Visit>
  void each_active_row(const Visit& visit);
  double clip_step();
  void move_particles(double length);

  GridEquations equations_;
  const GridPlan& plan_ = equations_.plan;
  const TensionKernels& kernels_;
  LinePreconditioner preconditioner_;
  TensionTask task_;
  SpringTensions* tension_ = nullptr;
  Vec3Field* position_ = nullptr;
  double unit_ = 0;                   ///< m/N: (time step)^2 times the largest inverse mass
  std::vector<double> inverse_mass_;  ///< 1/kg, of the present weights
  AlignedDoubles x_, y_, z_, weight_;
  AlignedFloats sx_, sy_, sz_;  ///< W J^T d for the search direction d of conjugate gradients
  RowInterval moved_;           ///< rows of particles that have moved since the last evaluation
  double shortest_ = 0;         ///< m, smallest rest length
  std::array<AlignedFloats, 6> line_scratch_;
  AlignedDoubles lanes_weight_;  ///< weight_, transposed: one row in each lane, block after block
  AlignedDoubles lanes_x_, lanes_y_, lanes_z_, lanes_;  ///< positions and tensions, transposed
};

}  // namespace cloth
