// Implicit Euler by Gauss-Seidel passes over the springs: extended position-based dynamics (Macklin et al.
// 2016), in substeps (Macklin et al. 2019).
//
// A substep of h = time step / substeps first predicts with everything but the springs,
//
//     W_i^-1 v* = m_i v_i + h p_i,    W_i^-1 = (m_i + h c) I + h c_a n n^T
//
// (p gravity, wind and hand at x and t + h, n the normals at x; the hand adds its h c + h^2 k to W^-1), then
// passes over the springs in a fixed order, by colours (kernels/coloured_springs.h), then over the elements
// of bending, sliders and triangles in theirs. The spring between i and j has gathered an impulse P (N s) on
// j and -P on i, v = v* + W P, x' = x + h v; with l = |x'_j - x'_i| and d = (x'_j - x'_i)/l it is to become
//
//     P = lambda d,    lambda = -h (k (l - L) + k_d d . (v_j - v_i))
//
// which, times h, is the paper's constraint of compliance 1/k with its damping term, gamma = k_d / (k h),
// multiplied by h^2 k. The paper moves positions and takes v = (x' - x)/h at the end; moving velocities
// instead is the same and does not round off the momentum.
//
// The paper adds every change of lambda along the direction of that moment and leaves the earlier ones where
// they were. Where springs turn within a substep its passes then converge to something beside the implicit
// Euler step. Here a visit turns the whole of P into the present direction, so that the limit is that step
// (with normals and wind at the start); on a straight line both are the same.
//
// A bending element (cloth/bending.h) has the impulse P on s = sum c x, linear in s: P = -h k (s' + t sum c
// v'). A triangle of constant strain (cloth/membrane.h) has three impulses along its edges, solved for
// together: lambda = -h K (q' + t dq'/dt), with q' to first order in the change of a visit.
// A slider of hysteresis (cloth/bending_sliders.h) has an impulse along its normal, bounded by its yield.
//
// The kernels visit the springs of a colour many at a time (kernels/coloured_visits.h), and the other
// elements (kernels/projected_elements.h). On a grid of springs alone, without drag and with one iteration,
// where a visit begins without an impulse, they do so in an order of the grid's own, without lists of springs
// (kernels/grid_projection.h).
#pragma once

#include "integrators/integrator.h"
#include "kernels/coloured_springs.h"
#include "kernels/projected_elements.h"

namespace cloth {

class Xpbd : public Integrator {
 public:
  Xpbd(int substeps, int iterations) : substeps_(substeps), iterations_(iterations) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  std::string visits_text(const ForceModel& forces) override;
  /// Kept at the end of every substep.
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return true;
  }
  void set_inner_contact(InnerStepContact* contact) override { contact_ = contact; }

 private:
  /// W = isotropic * I - along_normal * n n^T, in 1/kg; all 0 where pinned.
  struct Mobility {
    double isotropic = 0, along_normal = 0;
    Vec3 normal{0, 0, 0};
    Eigen::Matrix3d matrix() const {
      return isotropic * Eigen::Matrix3d::Identity() - along_normal * normal * normal.transpose();
    }
    Vec3 times(const Vec3& v) const { return isotropic * v - along_normal * normal.dot(v) * normal; }
  };

  /// Who visits the springs: the kernels in the grid's order, the kernels by colours, or visit() below.
  enum class Visitor { grid, colours, one_by_one };
  Visitor visitor_for(const ForceModel& forces, const NodeDamping& parts);
  /// What substeps of h need of the particles' masses.
  void begin_substeps(const ForceModel& forces, const NodeDamping& parts, double h);
  /// One substep from `position` to the velocity at its end; returns the largest squared change of a
  /// particle's velocity by a visit of the last pass, if it is `measured`.
  double substep(const ForceModel& forces, const NodeDamping& parts, double h, bool measured,
                 const Vec3Field& position, Vec3Field& velocity);
  void predict(const ForceModel& forces, const NodeDamping& parts, Vec3Field& velocity);
  void note_mobilities(const NodeDamping& parts);
  /// Over all springs and other elements, once; returns the largest squared change of a particle's velocity
  /// by a visit.
  double pass(const ClothSystem& system, const Vec3Field& start, double h, bool measured,
              Vec3Field& velocity);
  double visit_springs(const ClothSystem& system, const Vec3Field& start, double h, Vec3Field& velocity);
  double visit_others(const ClothSystem& system, const Vec3Field& start, double h, Vec3Field& velocity);
  double visit(const SpringRun& run, std::size_t i, const Vec3Field& start, double h, Vec3& impulse,
               Vec3Field& velocity) const;
  double visit(const BendingRun& run, int first, const Vec3Field& start, double h, Vec3& impulse,
               Vec3Field& velocity) const;
  /// `impulse`: of its three corners.
  double visit(const MembraneTriangle& triangle, const Vec3Field& start, double h, Vec3* impulse,
               Vec3Field& velocity) const;
  double visit(const BendingSlider& slider, std::size_t number, const Vec3Field& start, double h,
               Vec3& impulse, Vec3Field& velocity) const;
  static std::size_t impulse_count(const ClothSystem& system);

  int substeps_, iterations_;
  DriftConstraint* constraint_ = nullptr;
  InnerStepContact* contact_ = nullptr;
  Visitor visitor_ = Visitor::one_by_one;
  bool has_others_ = false;  ///< elements beside springs
  ColouredSprings coloured_;
  ProjectedElements elements_;
  // w (1/kg, 0 where pinned); v* = (I - along n n^T) (kept v + pushed p), b b^T = w along n n^T.
  std::vector<double> isotropic_, kept_, pushed_, along_;
  Vec3Field drag_;  ///< b, kg^-1/2: W = w I - b b^T
  // Only where elements are visited one by one.
  std::vector<Mobility> mobility_;
  /// N s, of every spring, run after run, then of every bending element, then of every slider (its first
  /// number), then of every triangle's corners.
  std::vector<Vec3> impulse_;
  const SliderState* sliders_ = nullptr;
  double spring_damping_ = 0;                                       ///< N s/m
  double stretch_time_ = 0, bending_time_ = 0, membrane_time_ = 0;  ///< s
};

}  // namespace cloth
