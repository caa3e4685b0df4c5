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
#pragma once

#include "integrators/implicit/linear_solver.h"
#include "integrators/integrator.h"

namespace cloth {

class Projective : public Integrator {
 public:
  explicit Projective(int iterations) : iterations_(iterations) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool drifts_with_end_velocity() const override { return true; }

 private:
  /// What A consists of beside springs, masses and pins. Units as in NodeDamping.
  struct Coefficients {
    double step = 0;
    NodeCoefficient node_damping;
    double spring_damping = 0, stretch_time = 0, bending_time = 0, membrane_time = 0;
    int held_particle = -1;
    double held_damping = 0, held_stiffness = 0;
    bool operator==(const Coefficients&) const = default;
  };

  bool factorise(const ClothSystem& system, const Coefficients& numbers);
  double correct(const ClothSystem& system, const Vec3Field& start_velocity, double h, Vec3Field& velocity);

  int iterations_;
  bool factored_ = false;  ///< `factors_` are those of A with these:
  Coefficients coefficients_;
  SpringRuns springs_;
  BendingRuns bending_;
  Membrane membrane_;
  BendingSliders sliders_;
  std::vector<double> mass_;
  std::vector<std::uint8_t> pinned_;
  FreeRows rows_;
  BlockCholesky factors_{1};
  Vec3Field force_, start_position_, start_velocity_;
  std::vector<double> residual_;  ///< N s, of the free particles: x, y, z one after the other
};

}  // namespace cloth
