// The springs of a grid in one pass over its rows, together with what an explicit method does with the force:
// see spring_sweep.h. Chooses the instruction set, shares the rows among threads and adds up what the rows
// report.
//
// The same bits for any number of threads: every band of rows makes its sums in the order in which one
// thread makes them, from copies of the neighbours' rows taken before anybody writes.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_pass.h"
#include "kernels/instruction_set.h"
#include "kernels/spring_sweep.h"

namespace cloth {

/// The springs of `system` if they are those of make_grid: six directions of constant offset, each of one
/// stiffness and rest length; whole families may be absent.
std::optional<kernels::Grid> recognise_grid(const ClothSystem& system);

const kernels::GridKernels& grid_kernels(InstructionSet set);

class GridSweep : public SpringSweep {
 public:
  /// Both must outlive the sweep.
  GridSweep(const ClothSystem& system, const kernels::Grid& grid, std::optional<double> mass);

  int threads() const override;
  Squares euler(double step, bool drift_first, const SweepLoads& loads, ClothState& state) override;
  Squares verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) override;
  void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                    ClothState& state) override;
  std::array<double, 5> runge_kutta(double step, const SweepLoads& loads, ClothState& state) override;
  void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) override;
  double squares(const Vec3Field& velocity) override;

 private:
  using Kernel = void (*)(const kernels::Pass&);

  /// A field of a pass. Where `halo_rows` are asked for, the pass steps the field in place and reads so many
  /// of the rows around a band's own; else a band keeps to its own rows, or nobody writes.
  struct Attached {
    kernels::BandField kernels::Pass::*field;
    Vec3Field* values;
    int halo_rows;
  };
  struct Plan {
    PassKind kind;
    Kernel kernel;
    const SweepLoads& loads;
    double step = 0;  ///< s
    bool drift_first = false;
    std::array<Attached, 3> fields{};  ///< those without values are none
    int scratch_rows = kernels::euler_scratch_rows;
  };
  /// What a band needs of its own; written by the thread that steps it alone.
  struct alignas(64) Band {
    kernels::Pass pass;
    AlignedDoubles scratch, halo;
  };
  void run(const Plan& plan);
  void make_room(const Plan& plan, std::size_t bands);
  void prepare(const Plan& plan, std::size_t index);
  kernels::BandField with_copies(const Attached& attached, const kernels::Pass& pass, double* to) const;
  double sum_of(int which) const;

  const ClothSystem* system_;
  kernels::Grid grid_;
  const kernels::GridKernels* kernels_;
  std::vector<Band> bands_;
  std::vector<double> squares_;  ///< see kernels::Pass
};

}  // namespace cloth
