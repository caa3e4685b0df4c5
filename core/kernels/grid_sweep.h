// The springs of a grid in one pass over its rows, together with what an explicit method does with the force:
// see spring_sweep.h. Chooses the instruction set, shares the rows among threads and adds up what the rows
// report.
//
// The same bits for any number of threads: every band of rows makes its sums in the order in which one
// thread makes them, from copies of the rows at its neighbours' edges that these leave for it between two
// passes.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_pass.h"
#include "kernels/spring_sweep.h"

namespace cloth {

/// The six directions of springs of `system` if they are those of make_grid; whole families may be absent.
std::optional<kernels::Grid> grid_springs(const ClothSystem& system);

class GridSweep : public SpringSweep {
 public:
  /// Both must outlive the sweep.
  GridSweep(const ClothSystem& system, const kernels::Grid& grid, std::optional<double> mass);

  int threads() const override;
  void euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
             ClothState& state) override;
  double verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) override;
  void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                    ClothState& state) override;
  void runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                   ClothState& state) override;
  bool takes_air() const override { return true; }
  /// Threads that step on need not be called for every step.
  bool gains_steps_at_once() const override { return threads() > 1; }
  void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) override;
  double damp(double damping, const Vec3Field& position, const Vec3Field& velocity,
              Vec3Field& product) override;
  double squares(const Vec3Field& velocity) override;

 private:
  using Kernel = void (*)(const kernels::Pass&);

  /// A field of a pass. Where `halo_rows` are asked for, the pass steps the field in place and reads so many
  /// of the rows around a band's own; else a band keeps to its own rows, or the field is only read.
  struct Attached {
    kernels::BandField kernels::Pass::*field;
    Vec3Field* values;
    int halo_rows;
  };
  struct Plan {
    Kernel kernel;
    Kernel opening = nullptr, closing = nullptr;  ///< the first and the last pass, where they are others
    const SweepLoads& loads;
    double step = 0;  ///< s
    bool drift_first = false;
    std::array<Attached, 3> fields{};  ///< those without values are none
    int sums = kernels::step_sums;
    int scratch_rows = kernels::step_scratch_rows;
    int evaluations = 1;  ///< of the force, in a step

    bool has_edges() const {
      return std::any_of(fields.begin(), fields.end(),
                         [](const Attached& attached) { return attached.halo_rows > 0; });
    }
  };
  /// What a band needs of its own; written by the thread that steps it alone, except that a neighbour may
  /// write to the edges that were left for it.
  struct alignas(64) Band {
    kernels::Pass pass;
    AlignedDoubles scratch;
    std::array<AlignedDoubles, 2> edges;  ///< of the attached fields; passes take turns
    Milestone published;                  ///< the pass, from 1 on, before which its edges were left
  };
  void run(const Plan& plan, std::size_t passes, int threads);
  void step_band(const Plan& plan, std::size_t index, std::size_t passes);
  void run_once(PassKind kind, const Plan& plan) {
    in_jobs(kind, 1, [&](std::size_t, std::size_t, int threads) { run(plan, 1, threads); });
  }
  void make_room(const Plan& plan, std::size_t passes, std::size_t bands);
  void prepare(const Plan& plan, std::size_t index);
  void publish(const Plan& plan, std::size_t index, std::size_t pass);
  void await_neighbours(const Plan& plan, std::size_t index, std::size_t pass);
  double sum_of(const Plan& plan, std::size_t pass, int which) const;

  const ClothSystem* system_;
  kernels::Grid grid_;
  const kernels::GridKernels* kernels_;
  std::deque<Band> bands_;
  std::vector<double> sums_;  ///< of every pass of a job, see kernels::Pass
};

}  // namespace cloth
