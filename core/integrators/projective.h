// Implicit Euler by iterations with one constant matrix: projective dynamics (Liu et al. 2013)
// read as a quasi-Newton method (Liu et al. 2017).
//
// A step is the solution v' of  r(v') = M (v' - v) - h f(x + h v', v', t + h) = 0,  x' = x + h v'.
// From the inertial guess v' = v every iteration takes
//
//     v' <- v' - A^-1 r(v'),    A = M + h D_max + h^2 L
//
// L is the graph Laplacian of the springs weighted by their stiffness: N x N, the same for x, y and z. A
// spring's force on its first end is k d - k L_0 d/|d|; with p = L_0 d/|d| held fixed (the local step: the
// nearest vector of the rest length) the step equation is the linear system A x' = ... of Liu et al. (the
// global step), and its solution is exactly the iteration above. D_max bounds D whatever the shape: viscous
// damping and air on the diagonal (n n^T <= I), spring damping as the Laplacian weighted by it (d d^T <= I),
// the hand's spring and damping on its particle. A material's bending is linear, so that its matrix is in A
// exactly. A triangle of constant strain (cloth/membrane.h) is in A as three springs that bound it near its
// rest length: one that is stretched far can be stiffer than A, and more so the farther.
//
// So A is never less than the derivative of r by springs and damping, and an iteration lowers the incremental
// potential wherever it is one. Wind is left out of A: its force changes with the normals, but is bounded
// whatever the shape, and the rest of the iteration contracts; iterates stay bounded in any wind.
//
// On a grid one cycle of multigrid stands for A^-1 where it reduces the error enough
// (integrators/projective_matrix.h). Iterations may be accelerated (integrators/acceleration.h): a proposal
// whose residual is larger in the norm of A^-1 than that of the iterate it came from is replaced by the plain
// iterate, and the acceleration begins anew. The last two iterations of a step are plain ones, so that no
// proposal goes unexamined.
#pragma once

#include "integrators/acceleration.h"
#include "integrators/integrator.h"
#include "integrators/projective_matrix.h"
#include "integrators/step_equation.h"

namespace cloth {

class Projective : public Integrator {
 public:
  explicit Projective(int iterations, std::unique_ptr<Acceleration> acceleration = nullptr)
      : iterations_(iterations), acceleration_(std::move(acceleration)) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  const Vec3Field* force_left(ForceModel& forces, const StepTimes& times) override {
    return &left_.force_left(forces, times);
  }
  bool drifts_with_end_velocity() const override { return true; }

 private:
  void iterate(ForceModel& forces, const StepTimes& times, ClothState& state, IntegratorReport& report);
  void find_residual(ForceModel& forces, const StepTimes& times, ClothState& state);
  double advance(bool may_accelerate, double merit, Vec3Field& velocity);

  int iterations_;
  std::unique_ptr<Acceleration> acceleration_;
  ProjectiveMatrix matrix_;
  Vec3Field force_, start_position_, start_velocity_;
  Vec3Field residual_;          ///< r, N s, zero on pins
  Vec3Field correction_;        ///< A^-1 r, m/s
  bool accelerated_ = false;    ///< the present velocity is a proposal, and
  Vec3Field plain_, proposal_;  ///< the plain iterate in its place
  LeftStep left_;
};

}  // namespace cloth
