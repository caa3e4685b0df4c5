// Computes the spring forces of a cloth and the update of an explicit method in one pass over the particles,
// so that a whole step reads and writes every particle once. Two implementations: grids
// (grid_sweep.h) and general meshes (mesh_sweep.h). Results are bitwise the same for any number of threads.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <span>

#include "cloth/cloth_system.h"
#include "kernels/thread_choice.h"
#include "kernels/worker_team.h"

namespace cloth {

/// The mass of every particle in kg, if all have the same.
std::optional<double> common_mass(const ClothSystem& system);

/// Drag of the air along the normal and friction across it, F_i = drag (n . w) n + friction (w - (n . w) n),
/// w = wind - v_i (forces/air.h), with the wind at each force evaluation of a step.
struct SweptAir {
  double drag = 0, friction = 0;  ///< N s/m
  std::array<Vec3, 4> wind;       ///< m/s, one for each evaluation of the step; unused where neither acts
  bool acts() const { return drag > 0 || friction > 0; }
};

struct SliderGrid;

/// The forces beside the springs' elastic ones: f = springs + weight + load + air - damping v - D v, where D
/// are dampers along the springs: F_i = k_d ((v_j - v_i) . d/|d|) d/|d|, 0 where |d| = 0, with k_d =
/// spring_damping + stretch_time k; and t K v of the bending elements. Of a grid assembled cell by cell
/// (GridSweep::has_shares()), weight, damping and the air's coefficients are those of a particle inside, of
/// which the others have their share.
struct SweepLoads {
  Vec3 weight{0, 0, 0};             ///< N, on every particle
  double damping = 0;               ///< N s/m
  const Vec3Field* load = nullptr;  ///< N, or none
  double spring_damping = 0;        ///< N s/m
  double stretch_time = 0;          ///< s; only of grids assembled cell by cell
  double bending_time = 0;          ///< s; likewise
  bool has_dampers() const { return spring_damping > 0 || stretch_time > 0 || bending_time > 0; }
  SliderGrid* sliders = nullptr;  ///< of hysteresis; only where takes_sliders()
  SweptAir air{};  ///< only for euler(), predicted() and runge_kutta(), and only if takes_air()
};

/// How a step of velocity Verlet that does not solve for its velocity goes on from one of its evaluations:
/// where the velocity has held h/2 f/m of the evaluation before, it gets h/2 (gain f' - held f)/m.
struct VelocityUpdate {
  double gain = 1, held = 1;
};

/// Sums over all particles and springs that a step computes in the same pass.
struct StepSums {
  double before = 0, after = 0;  ///< of |v|^2, in (m/s)^2
  double dampers = 0;            ///< W, dissipated by dampers along springs in the state before the step
  double air = 0;                ///< W, given by the air in the state before the step
};

/// The same at the four stages of a Runge-Kutta step.
struct StageSums {
  std::array<double, 4> squares{};  ///< of |v|^2, in (m/s)^2
  std::array<double, 4> dampers{};  ///< W
  std::array<double, 4> air{};      ///< W
  double after = 0;                 ///< of |v|^2, after the step
};

class SpringSweep {
 public:
  /// `mass` (kg): see common_mass(); of a grid assembled cell by cell that of a particle inside. euler(),
  /// verlet() and runge_kutta() require it.
  explicit SpringSweep(std::optional<double> mass) : mass_(mass) {}
  virtual ~SpringSweep() = default;

  bool has_common_mass() const { return mass_.has_value(); }
  double mass() const { return mass_.value(); }

  /// Sets the threads that share the particles; null: one thread.
  void set_team(WorkerTeam* team, ThreadUse use = ThreadUse::where_they_gain) { team_ = team, use_ = use; }
  /// How many of the team's threads a pass may use; 1 where the shares would be too small.
  virtual int threads() const = 0;

  /// v' = v + h a(x, v), x' = x + h v' (or, drift_first, x + h v). Takes as many steps as there are `sums`,
  /// with bitwise the same result as single steps. With a load only one step is allowed.
  virtual void euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
                     ClothState& state) = 0;
  /// One step of velocity Verlet with centred damping. `force` (N) must hold springs + weight at the state's
  /// position and holds it again afterwards. No load, no dampers along springs. Returns the sum of |v|^2
  /// after the step, (m/s)^2.
  virtual double verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) = 0;
  /// As many steps as there are `squares`, with bitwise the same result as that many calls of verlet().
  /// Stores the sum of |v|^2 after each step in `squares`.
  virtual void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                            ClothState& state) = 0;
  /// Of a step of velocity Verlet whose forces, dampers and air included, are taken at a velocity that is not
  /// solved for (integrators/verlet.h): drift and first evaluation. `force` (N) holds f before and after. No
  /// load. Only if takes_predicted(). The sums `before`, `dampers` and `air` are those at the velocity of the
  /// evaluation, v + (1 + held) h/2 f/m: by default the one that f predicts, hence the name.
  virtual StepSums predicted(double /*step*/, const VelocityUpdate&, const SweepLoads&, Vec3Field& /*force*/,
                             ClothState&) {
    return {};
  }
  /// The same in two parts: the drift, which leaves that velocity in the state; and an evaluation at the
  /// state, which may be repeated. With step = 0 it only computes f.
  virtual void predicted_open(double /*step*/, const VelocityUpdate&, const SweepLoads&, Vec3Field& /*force*/,
                              ClothState&) {}
  virtual StepSums predicted_close(double /*step*/, const VelocityUpdate&, const SweepLoads&,
                                   Vec3Field& /*force*/, ClothState&) {
    return {};
  }
  virtual bool takes_predicted() const { return false; }
  /// Kutta's method of order four (kutta.h). Takes as many steps as there are `sums`. No load.
  virtual void runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                           ClothState& state) = 0;
  /// Whether particles, and springs, have the shares of their cells, and whether the cloth's bending is part
  /// of the springs' force.
  virtual bool has_shares() const { return false; }
  /// Whether SweepLoads::air is supported.
  virtual bool takes_air() const { return false; }
  /// Whether the sliders of hysteresis are supported (kernels/slider_grid.h); then
  virtual bool takes_sliders() const { return false; }
  /// the end of a step with them: slips follow where sliders have yielded, normals are taken anew. Returns
  /// the energy in J that is gone. `force` (N; null: none) that holds what acts at `position` follows.
  virtual double end_sliders(SliderGrid&, const Vec3Field& /*position*/, Vec3Field* /*force*/) { return 0; }
  /// Normals alone, and the energy in J that is stored.
  virtual void take_slider_normals(SliderGrid&, const Vec3Field& /*position*/) {}
  virtual double slider_energy(SliderGrid&, const Vec3Field& /*position*/) { return 0; }
  /// Whether several steps of euler() or runge_kutta() in one call cost less than single steps.
  virtual bool gains_steps_at_once() const = 0;

  /// force = springs + weight + load; `load` may be `force`.
  virtual void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) = 0;
  /// to = from. Each thread copies the particles that it will update, so that they are in its cache.
  void copy(const ClothState& from, ClothState& to);
  /// product = D v of the dampers along the springs at `position`, and of bending. Returns the power in W
  /// that they dissipate.
  virtual double damp(const SweepLoads& dampers, const Vec3Field& position, const Vec3Field& velocity,
                      Vec3Field& product) = 0;
  /// Whether project() is supported: springs of finite stiffness, and of one for each direction.
  virtual bool projects() const { return false; }
  /// Takes the mobilities (1/kg, of each particle, 0 where pinned) for the calls of project() that follow;
  /// they must stay where they are. Precondition: projects().
  virtual void begin_projections(const std::vector<double>& mobility);
  /// XPBD's first visit of every spring in a step from `position` (kernels/grid_projection.h), in an order of
  /// its own: changes `velocity`. `spring_damping`: N s/m. Returns the largest squared change of a particle's
  /// velocity by a visit.
  virtual double project(double step, double spring_damping, const Vec3Field& position, Vec3Field& velocity);
  /// The sum of |v|^2, in the order in which the steps add it up.
  virtual double squares(const Vec3Field& velocity) = 0;

 protected:
  /// Each kind is timed separately and chooses its own number of threads.
  enum class PassKind { step, several_steps, evaluation, dampers, sums, copies, drift, closing, sliders };
  static constexpr std::size_t pass_kinds = 9;
  static PassKind kind_of(std::size_t steps) { return steps == 1 ? PassKind::step : PassKind::several_steps; }
  /// Smallest number of particles per thread. With fewer, waking the threads takes as long as the pass.
  static constexpr int fewest_particles = 250;

  /// Calls job(first, count, threads) until `passes` passes are done; each call does the passes first to
  /// first + count - 1, as many as ThreadChoice::at_once() allows.
  template <class Job>
  void in_jobs(PassKind kind, std::size_t passes, const Job& job) {
    for (std::size_t done = 0; done < passes;) {
      const Begun begun = begin_job(kind, passes - done);
      job(done, begun.passes, begun.threads);
      end_job(kind, begun);
      done += begun.passes;
    }
  }

  WorkerTeam* team() const { return team_; }
  int team_size() const { return team_ ? team_->size() : 1; }

 private:
  struct Begun {
    std::size_t passes = 0;
    int threads = 1;
    std::chrono::steady_clock::time_point at = {};  ///< start time, if ThreadChoice wants it
  };
  Begun begin_job(PassKind kind, std::size_t passes);
  void end_job(PassKind kind, const Begun& begun);

  std::optional<double> mass_;
  WorkerTeam* team_ = nullptr;
  ThreadUse use_ = ThreadUse::where_they_gain;
  std::array<ThreadChoice, pass_kinds> choices_;
};

}  // namespace cloth
