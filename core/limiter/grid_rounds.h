// TensionRounds for grids: whole families of lines side by side. Rows without a spring that is over its limit
// or has a tension are left out as far as they lie above and below all that have one.
#pragma once

#include "limiter/grid_plan.h"
#include "limiter/tension_kernels.h"
#include "limiter/tension_rounds.h"

namespace cloth {

class GridRounds : public TensionRounds {
 public:
  explicit GridRounds(const GridPlan& plan);

  void begin(const TensionTask& task, const std::vector<double>& inverse_mass,
             const std::vector<double>& tension, const Vec3Field& position) override;
  TensionResidual evaluate() override;
  void sweep_lines(bool backwards) override;
  int solve_together() override;
  void end(std::vector<double>& tension, Vec3Field& position) const override;

 private:
  /// A family's springs, each at the place of the particle that it begins at.
  struct Family {
    GridFamily plan;
    std::ptrdiff_t offset;
    AlignedDoubles tension;                   ///< m, times h^2 and the largest inverse mass
    tension::AlignedFloats ax, ay, az, over;  ///< equations
    tension::AlignedFloats link, pivot;       ///< factors; of rows in lanes
    tension::AlignedFloats change, residual, solved, direction, product;  ///< of conjugate gradients
    std::vector<tension::RowLengths> lengths;                             ///< of each row
    std::vector<tension::RowResidual> residuals;                          ///< of each row, of soft springs
    std::vector<std::uint8_t> pins;  ///< rows with springs between two pins
    bool is_row() const { return plan.down == 0; }
  };
  struct Interval {
    int begin = 0, end = 0;  ///< rows
  };

  tension::SpringRule rule_of(const Family& family) const;
  tension::Nodes nodes();
  bool is_active(const Family& family, int row) const;
  void take_weights(const std::vector<double>& inverse_mass);
  void equate(Family& family, int row);
  void measure(Family& family, int row);
  Interval rows_of(const Family& family, Interval rows) const;
  void sweep_rows(Family& family);
  void sweep_columns(Family& family);
  void find_equations();
  void factorise();
  void factorise_lanes(Family& family);
  void eliminate(Family& family, int row);
  void precondition_lanes(Family& family, int first_row);
  int pulls_on(int row, tension::AlignedFloats Family::*value, tension::PullTerm* terms) const;
  void pull(int row, tension::AlignedFloats Family::*value);
  double advance(double length);
  double precondition();
  int conjugate_gradients();
  void take_step();
  double apply(tension::AlignedFloats Family::*value, double ridge);

  GridPlan plan_;
  TensionTask task_;
  double unit_ = 0;  ///< m/N, h^2 times the largest inverse mass
  std::vector<Family> families_;
  std::vector<double> inverse_mass_;  ///< that the weights are of
  AlignedDoubles x_, y_, z_, weight_;
  tension::AlignedFloats light_;         ///< weights
  tension::AlignedFloats sx_, sy_, sz_;  ///< w J^T of what conjugate gradients look at
  tension::AlignedFloats zero_;          ///< a row
  Interval moved_;                       ///< rows of particles since the last evaluation
  Interval active_;                      ///< rows in which active springs begin
  double shortest_ = 0;                  ///< rest length
  tension::LineScratch scratch_;
  AlignedDoubles lanes_weight_;  ///< of all rows, block after block
  tension::AlignedFloats floats_weight_;
  AlignedDoubles lanes_x_, lanes_y_, lanes_z_, lanes_;              ///< rows side by side
  tension::AlignedFloats floats_x_, floats_y_, floats_z_, floats_;  ///< rows side by side
};

}  // namespace cloth
