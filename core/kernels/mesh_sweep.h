// SpringSweep for general meshes; the springs are stored as in mesh_layout.h.
#pragma once

#include <vector>

#include "kernels/mesh_layout.h"
#include "kernels/spring_sweep.h"

namespace cloth {

class MeshSweep : public SpringSweep {
 public:
  /// Copies what it needs of `system`. `mass`: see SpringSweep. Springs may join any particles:
  /// F_i = k (|d| - L) d/|d| with d = x_j - x_i, and 0 where |d| = 0.
  MeshSweep(const ClothSystem& system, std::optional<double> mass);

  int threads() const override;
  void euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
             ClothState& state) override;
  double verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) override;
  void verlet_steps(double step, const SweepLoads& loads, std::span<double> squares, Vec3Field& force,
                    ClothState& state) override;
  void runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                   ClothState& state) override;
  /// Several steps at once reorder the state to the layout's order and back only once.
  bool gains_steps_at_once() const override { return !layout_.order.empty(); }
  void evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) override;
  double damp(const SweepLoads& loads, const Vec3Field& position, const Vec3Field& velocity,
              Vec3Field& product) override;
  double squares(const Vec3Field& velocity) override;

  const MeshLayout& layout() const { return layout_; }

 private:
  using Kernel = void (*)(const kernels::MeshPass&);
  /// The fields that a pass works on: the caller's own, or copies in the layout's order.
  struct Fields {
    Vec3Field position, velocity, force, load;
  };

  Vec3Field& take(Vec3Field& field, Vec3Field& copy);
  void give_back(const Vec3Field& copy, Vec3Field& field);
  kernels::MeshPass pass_with(const SweepLoads& loads, double step);
  void load_all(const kernels::MeshPass& pass);
  kernels::FieldPointers read(const Vec3Field& field, Vec3Field& copy);
  void run(kernels::MeshPass& pass, Kernel kernel);
  void run_loaded(const kernels::MeshPass& pass, Kernel kernel);
  template <class Steps>
  void step_state(std::size_t all, double step, const SweepLoads& loads, ClothState& state,
                  const Steps& steps);
  template <class Inputs>
  void compute(PassKind kind, Kernel kernel, const SweepLoads& loads, Vec3Field& result,
               const Inputs& inputs);
  template <class Visit>
  void for_each_share(int of, Visit visit);
  double sum_of(int which) const;
  void runge_kutta_step(kernels::MeshPass& pass, double step, const kernels::FieldPointers& x,
                        const kernels::FieldPointers& v);

  MeshLayout layout_;
  ParticleOrder number_;  ///< inverse of the layout's order
  const kernels::MeshKernels* kernels_;
  std::vector<double> inverse_mass_;
  AlignedDoubles vectors_;
  AlignedDoubles velocities_;    ///< sized when springs are damped
  std::vector<double> squares_;  ///< see kernels::MeshPass: five arrays of |v|^2 and four of dampers
  Fields inner_;
  ClothState stage_, sum_;  ///< of Runge-Kutta
  int sharing_ = 1;         ///< threads of the present job
};

}  // namespace cloth
