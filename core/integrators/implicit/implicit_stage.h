// One implicit stage, the same for every implicit method: the velocity v with
//
//     M (v - v0) = weight f(x0 + weight v, v, time)
//
// by Newton's method in v. Implicit Euler takes weight = h, the midpoint rule h/2, BDF2 2h/3.
//
// Each iteration solves with the exact Jacobian. Where that is indefinite, the transverse stiffness of
// compressed springs is left out (Choi and Ko 2002), so that the direction is one of descent and the
// iteration does not end at a saddle point. The line search uses the work of the residual along the direction
// (Matthies and Strang 1979); it needs no energy, since drag and dampers have none.
//
// Where the exact Jacobian has a direction of negative curvature, where it had one and a step had to be
// shortened, and where five iterations did not come near the solution, the linear model holds only nearby:
// springs that turn get longer by the square of the turning.
// The residual is then relaxed by a quasi-Newton method that evaluates forces instead of multiplying with the
// matrix, and has factors, or a cycle of multigrid that is made anew on the way, as preconditioner: it goes
// much further for the cost of one linear solve.
//
// Where that does not lead to the solution and forces have no potential, the residual's norm is lowered
// instead, along directions of the whole Jacobian. Where that fails too and air acts along normals of the
// cloth, these are held as they are at x0 (with BDF2 ahead of the step's beginning, by as much as its x0),
// and the step begins anew: air alone, without a brush, is then a damper whose Jacobian is symmetric, and the
// step's error is of order one. The report counts such solves.
#pragma once

#include "integrators/implicit/limited_memory.h"
#include "integrators/implicit/linear_choice.h"
#include "integrators/implicit/linear_solver.h"
#include "integrators/implicit/multigrid_solver.h"
#include "integrators/integrator.h"

namespace cloth {

struct StageEquation {
  ForceModel& forces;               ///< stands at the solution afterwards
  double weight = 0;                ///< s
  double time = 0;                  ///< s, at which the forces are taken
  const Vec3Field& start_position;  ///< x0, m
  const Vec3Field& start_velocity;  ///< v0, m/s
  Vec3Field& velocity;              ///< m/s, holds the guess and becomes the solution v
  Vec3Field& position;              ///< m, becomes x0 + weight v
  IntegratorReport& report;         ///< gets the cost added, and the failure if there is one
};

class ImplicitStage {
 public:
  /// `tolerance`: change of the velocities at which iterations end, relative to the largest speed.
  ImplicitStage(double tolerance, int max_iterations)
      : tolerance_(tolerance), max_iterations_(max_iterations) {}

  void solve(const StageEquation& equation);

 private:
  bool iterate(const StageEquation& e, bool may_give_up);
  void evaluate(const StageEquation& e);
  void find_direction(const StageEquation& e);
  void choose_forcing();
  void solve_whole(const StageEquation& e, LinearMethod method, double tolerance);
  void correct_direction(const StageEquation& e);
  void add_escape();
  bool solve_symmetric(const StageEquation& e, LinearMethod method);
  bool solve_by_factors(const StageEquation& e);
  bool make_cycle(const StageEquation& e);
  bool solve_by_multigrid(const StageEquation& e);
  void keep_escape(const KrylovReport& krylov);
  double take_step(const StageEquation& e);
  bool find_length(const StageEquation& e, double accepted);
  /// Not one that is worth more than an iteration of conjugate gradients.
  bool has_preconditioner() const { return linear_method_ != LinearMethod::conjugate_gradients; }
  LinearMap preconditioner(LinearMethod method);
  void relax(const StageEquation& e);
  bool lower_norm(const StageEquation& e, double smallest_change);
  bool is_solved(const StageEquation& e, double largest_change);

  double tolerance_;
  int max_iterations_;
  CholeskyFactors factors_;
  BlockJacobi jacobi_;
  MultigridSolver multigrid_;
  ConjugateGradients gradients_;
  MinimalResiduals minimal_residuals_;
  LinearMethod linear_method_ = LinearMethod::cholesky;
  double residual_norm_ = 0;    ///< N s, before the last iteration; 0: none, or a relaxation came after it
  double forcing_ = 0;          ///< tolerance of iterative solves, relative to the residual
  double length_ = 1;           ///< of the last step along its direction
  bool is_indefinite_ = false;  ///< the exact matrix was, in an iteration of this solve
  bool has_cycle_ = false;      ///< of multigrid, that serves the matrix of the next iteration
  bool cycles_solve_ = false;   ///< conjugate gradients with a cycle, where factors do not
  int futile_left_ = 0;         ///< steps of relaxations that may still gain little in this solve
  LimitedMemory memory_;
  Linearisation linearisation_, clamped_;
  Vec3Field force_, residual_, negative_residual_, downhill_, direction_, escape_, start_, turned_, guess_;
};

}  // namespace cloth
