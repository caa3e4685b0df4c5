// SpringSweep for grids. It chooses the instruction set, divides the rows into bands, one for each thread,
// and adds up the sums of the rows.
//
// Results are bitwise the same for any number of threads: each band adds its forces in the order in which one
// thread does, using copies of the neighbouring bands' edge rows, which these store between two passes.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_layout.h"
#include "kernels/spring_sweep.h"

namespace cloth {

class GridSweep : public SpringSweep {
 public:
  /// Both must outlive the sweep.
  GridSweep(const ClothSystem& system, const kernels::Grid& grid, std::optional<double> mass);
  /// Of a grid assembled cell by cell.
  GridSweep(const ClothSystem& system, CellLayout layout);

  int threads() const override;
  void euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
             ClothState& state) override;
  double verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) override;
  void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                    ClothState& state) override;
  StepSums predicted(double step, const VelocityUpdate& update, const SweepLoads& loads, Vec3Field& force,
                     ClothState& state) override;
  void predicted_open(double step, const VelocityUpdate& update, const SweepLoads& loads, Vec3Field& force,
                      ClothState& state) override;
  StepSums predicted_close(double step, const VelocityUpdate& update, const SweepLoads& loads,
                           Vec3Field& force, ClothState& state) override;
  bool takes_predicted() const override { return true; }
  void runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                   ClothState& state) override;
  bool has_shares() const override { return !layout_.part.empty(); }
  bool takes_air() const override { return true; }
  bool takes_sliders() const override { return has_shares(); }
  double end_sliders(SliderGrid& sliders, const Vec3Field& position, Vec3Field* force) override;
  void take_slider_normals(SliderGrid& sliders, const Vec3Field& position) override;
  double slider_energy(SliderGrid& sliders, const Vec3Field& position) override;
  /// Several steps at once start the threads only once.
  bool gains_steps_at_once() const override { return threads() > 1; }
  void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) override;
  double damp(const SweepLoads& dampers, const Vec3Field& position, const Vec3Field& velocity,
              Vec3Field& product) override;
  double squares(const Vec3Field& velocity) override;
  bool projects() const override;
  void begin_projections(const std::vector<double>& mobility) override;
  double project(double step, double spring_damping, const Vec3Field& position, Vec3Field& velocity) override;

 private:
  using Kernel = void (*)(const kernels::Pass&);

  /// A field of a pass. With `halo_rows` > 0 the pass changes the field in place and reads so many rows on
  /// either side of a band; with 0 a band reads only its own rows, or no band changes the field.
  struct Attached {
    kernels::BandField kernels::Pass::*field;
    Vec3Field* values;
    int halo_rows;
  };
  struct Plan {
    Kernel kernel;
    Kernel opening = nullptr, closing = nullptr;  ///< of the first and the last pass, if different
    const SweepLoads& loads;
    double step = 0;  ///< s
    bool drift_first = false;
    VelocityUpdate update{};           ///< of predicted Verlet
    std::array<Attached, 3> fields{};  ///< entries without `values` are unused
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
  StepSums step_sums_of(const Plan& plan, std::size_t pass) const;

  const ClothSystem* system_;
  kernels::Grid grid_;
  CellLayout layout_;  ///< empty: all particles and springs are alike
  const kernels::GridKernels* kernels_;
  std::deque<Band> bands_;
  std::vector<double> sums_;  ///< of every pass of a job, see kernels::Pass
  // Of begin_projections, see kernels::Projection.
  const double* mobility_ = nullptr;
  double common_mobility_ = 0;  ///< the largest
  std::vector<unsigned char> is_alike_;
};

}  // namespace cloth
