// Implicit Euler by Gauss-Seidel over the particles: vertex block descent (Chen, Liu, Yang and Yuksel 2024).
//
// A step is the minimum over x' of
//
//     G(x') = sum_i m_i/(2 h^2) |x'_i - y_i|^2 + E(x'),   y = x + h v + h^2 a_external,   v' = (x' - x)/h
//
// and a visit of a particle is one iteration of Newton's method for it alone, the others held: of what is
// left of its step equation, an impulse in N s, and of how that answers to its velocity, a matrix of 3 x 3 in
// kg,
//
//     r = W^-1 (v' - v*) - h f,   A = W^-1 + h D + h^2 K,   v' <- v' - A^-1 r
//
// f are the forces between particles at x' = x + h v' (springs with L/l of what they are in that shape, their
// dampers, a material's bending and membrane with theirs, its sliders), D and K the particle's own blocks of
// theirs. W^-1 v* = m v + h p has the rest: gravity, wind and the hand, W^-1 = (m + h c) I + h c_a n n^T, the
// hand adds its h c + h^2 k (as integrators/xpbd.h). Where normals matter all that is taken anew before every
// iteration, so that what the iterations tend to is the implicit Euler step.
//
// K is clamped: of a spring k [n n^T + max(1 - L/l, 0) (I - n n^T)], likewise of a triangle's edges, so that
// A is positive definite whatever the shape. A spring without length has k I and no force. No visit moves its
// particle further than where any element, or its inertia, alone would have it: the reach of a clamped matrix
// is too long where a cloth is crushed. All of bending, which is quadratic, is one element in that. The
// particles are visited colour by colour (cloth/particle_elements.h), many of a colour at a time
// (kernels/particle_descent.h).
//
// Chebyshev's semi-iteration (Wang 2015; Chen et al., section 3.8) extrapolates after every iteration but the
// last: x <- omega (x - x_before) + x_before, x_before the iterate that the last one began from was made of.
// Its weight, with rho the factor by which the slowest error falls in a plain iteration,
//
//     omega = 2/(1 + sqrt(1 - rho^2))
//
// is taken at its limit, and rho is not given but found: it begins at 0, and where the moves of an iteration
// fall more slowly, by q, than with this rho they would, it is taken from them (Hageman and Young 1981,
// chapter 6): rho = (q + (omega - 1)/q)/omega. It is never above 0.95, since the slowest errors of
// Gauss-Seidel are beyond what the semi-iteration stands (0.99 diverges). Where moves grow there is one
// iteration without extrapolation and a smaller rho.
#pragma once

#include <memory>

#include "cloth/particle_elements.h"
#include "integrators/integrator.h"
#include "integrators/step_equation.h"
#include "kernels/particle_descent.h"

namespace cloth {

/// The weights of the semi-iteration, one after each iteration.
class ChebyshevWeights {
 public:
  static constexpr double largest_radius = 0.95;
  /// `squares`: the sum of the squares of what the iteration has moved, in any unit.
  double next(double squares);
  double radius() const { return radius_; }  ///< rho

 private:
  int since_ = 0;  ///< iterations with this weight
  double move_ = 0, radius_ = 0, weight_ = 1;
};

class Vbd : public Integrator {
 public:
  Vbd(int iterations, bool accelerated) : iterations_(iterations), accelerated_(accelerated) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  const Vec3Field* force_left(ForceModel& forces, const StepTimes& times) override {
    return &left_.force_left(forces, times);
  }
  bool drifts_with_end_velocity() const override { return true; }
  std::string visits_text(const ForceModel& forces) override;

 private:
  /// W^-1 = mass I + along n n^T, in kg; mass 0 where pinned.
  struct Inertia {
    double mass = 0, along = 0;
    Vec3 normal{0, 0, 0};
  };
  /// Of one visit: A dv = push.
  struct Local {
    Vec3 push;             ///< N s, -r
    SymmetricBlock block;  ///< A, kg
    double reach = 0;      ///< m, the furthest that an element could ask for

    void add_isotropic(double value) { block.xx += value, block.yy += value, block.zz += value; }
    void add_along(double value, const Vec3& n) {
      const Vec3 m = value * n;
      block.xx += m.x() * n.x(), block.xy += m.x() * n.y(), block.xz += m.x() * n.z();
      block.yy += m.y() * n.y(), block.yz += m.y() * n.z(), block.zz += m.z() * n.z();
    }
    Vec3 solution() const;
  };
  /// What a step's visits share.
  struct Visits {
    const ClothSystem& system;
    NodeDamping parts;
    double step = 0;    ///< s
    ClothState& state;  ///< at the end of the step
  };
  struct Sweep {
    double change = 0;   ///< the largest, squared, of a particle's velocity, (m/s)^2
    double squares = 0;  ///< their sum
    int failed = -1;     ///< a particle whose equation had no finite solution; it has stayed
  };

  /// N/m: what a cloth's elements bring to the matrix of a particle at most, about.
  struct Stiffest {
    double spring = 0, bending = 0, edge = 0, slider = 0;
  };
  static Stiffest stiffest_of(const ClothSystem& system, const ParticleElements& elements);

  void prepare(const ClothSystem& system);
  void predict(const ForceModel& forces, const Vec3Field& reference, Visits& visits);
  /// The iterations, each sweep(k) and between two of them extrapolate(weight); returns the last sweep.
  template <class SweepOnce, class Extrapolate>
  Sweep iterate(const SweepOnce& sweep, const Extrapolate& extrapolate) const;
  /// v* and W^-1 at the positions that the visits have come to.
  void predict_again(ForceModel& forces, double end, Visits& visits, int& evaluations);
  /// The iterations by the kernels, where these know all there is, or one by one.
  bool suits_kernels(const NodeDamping& parts) const;
  bool is_visited_by_kernels(const Visits& visits) const;
  Sweep descend_by_kernels(ForceModel& forces, double end, Visits& visits, int& evaluations);
  void set_drag();
  Sweep descend(ForceModel& forces, double end, Visits& visits, int& evaluations);
  Sweep sweep(Visits& visits);
  Vec3 change_of(const Visits& visits, std::size_t i) const;
  void add_springs(const Visits& visits, std::size_t i, Local& local) const;
  void add_bending(const Visits& visits, std::size_t i, Local& local) const;
  void add_sliders(const Visits& visits, std::size_t i, Local& local) const;
  void add_triangles(const Visits& visits, std::size_t i, Local& local) const;
  void extrapolate(double weight, Visits& visits);

  int iterations_;
  bool accelerated_;
  ParticleElements elements_;
  Stiffest stiffest_;                         ///< where there is a descent_
  std::unique_ptr<ParticleDescent> descent_;  ///< null where a spring is rigid
  std::vector<double> mass_;                  ///< kg, of W^-1 for the kernels
  Vec3Field drag_;                            ///< kg^1/2, likewise: b b^T = along n n^T
  std::vector<Inertia> inertia_;
  Vec3Field start_position_, start_velocity_, predicted_;
  LeftStep left_;
  Vec3Field before_, present_;  ///< velocities of the iterate before the last, and of the last
};

}  // namespace cloth
