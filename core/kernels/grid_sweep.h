// The springs of a grid in one pass over its rows, together with what an explicit method does with the force:
// a whole step reads and writes every particle once. Chooses the instruction set, shares the rows among
// threads and adds up what the rows report.
//
// The same bits for any number of threads: every band of rows makes its sums in the order in which one
// thread makes them, from copies of the neighbours' rows taken before anybody writes.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_pass.h"
#include "kernels/instruction_set.h"
#include "kernels/thread_choice.h"
#include "kernels/worker_team.h"

namespace cloth {

/// The springs of `system` if they are those of make_grid: six directions of constant offset, each of one
/// stiffness and rest length; whole families may be absent.
std::optional<kernels::Grid> recognise_grid(const ClothSystem& system);

/// The mass of every free particle, if they have the same.
std::optional<double> common_mass(const ClothSystem& system);

const kernels::GridKernels& grid_kernels(InstructionSet set);

/// What acts beside the springs: f = springs + weight + load - damping v.
struct SweepLoads {
  Vec3 weight{0, 0, 0};             ///< N, on every particle
  double damping = 0;               ///< N s/m
  const Vec3Field* load = nullptr;  ///< N, or none
};

class GridSweep {
 public:
  /// Both must outlive the sweep. `mass` is that of the free particles; the steps below need it.
  GridSweep(const ClothSystem& system, const kernels::Grid& grid, std::optional<double> mass);

  bool has_common_mass() const { return mass_.has_value(); }
  double mass() const { return mass_.value(); }

  /// The team whose threads share the rows; null: one thread.
  void set_team(WorkerTeam* team, ThreadUse use = ThreadUse::where_they_gain) { team_ = team, use_ = use; }
  /// How many of the team's threads a pass may use: only one where a band would be too small.
  int threads() const;

  /// Sums over all particles of |v|^2, in (m/s)^2: before and after the step.
  struct Squares {
    double before = 0, after = 0;
  };
  /// v' = v + h a(x, v), x' = x + h v' (or, drift_first, x + h v).
  Squares euler(double step, bool drift_first, const SweepLoads& loads, ClothState& state);
  /// Velocity Verlet with centred damping; `force` holds springs + weight at the state's position, before and
  /// after. No load. Only `after` is given.
  Squares verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state);
  /// As many steps of verlet() as there are `squares`, to the bit, but `force` is left alone in between; each
  /// of the squares is a step's `after`.
  void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                    ClothState& state);
  /// Kutta's method of order four. No load. The sums at the four stages, and after the step.
  std::array<double, 5> runge_kutta(double step, const SweepLoads& loads, ClothState& state);

  /// force = springs + weight + load; `load` may be `force`.
  void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force);
  /// The sum of |v|^2 to the bits in which the steps report it.
  double squares(const Vec3Field& velocity);

 private:
  using Kernel = void (*)(const kernels::Pass&);
  /// Each takes its own time, and so makes its own choice of threads.
  enum class PassKind { step, opening, between, closing, evaluation, sums };
  static constexpr std::size_t pass_kinds = 6;

  struct Copy {
    const double* from;
    double* to;
    std::size_t count;
  };
  /// What a band needs of its own.
  struct Band {
    kernels::Pass pass;
    std::vector<Copy> copies;  ///< to be made before any band is stepped
    AlignedDoubles scratch, halo;
  };
  void share_rows(PassKind kind, int halo_rows, int scratch_rows, const SweepLoads& loads, double step);
  void attach(kernels::BandField kernels::Pass::*field, Vec3Field& values);
  void attach_with_copies(kernels::BandField kernels::Pass::*field, Vec3Field& values, int halo_rows,
                          int slot);
  void run(PassKind kind, Kernel kernel);
  double sum_of(int which) const;

  const ClothSystem* system_;
  kernels::Grid grid_;
  std::optional<double> mass_;
  const kernels::GridKernels* kernels_;
  WorkerTeam* team_ = nullptr;
  ThreadUse use_ = ThreadUse::where_they_gain;
  std::array<ThreadChoice, pass_kinds> choices_;
  std::chrono::steady_clock::time_point begun_;  ///< the pass, where its time is wanted
  std::vector<Band> bands_;
  std::vector<double> squares_;  ///< see kernels::Pass
};

}  // namespace cloth
