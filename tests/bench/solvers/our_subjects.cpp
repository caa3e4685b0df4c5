#include "bench/solvers/linear_subject.h"
#include "integrators/implicit/linear_solver.h"
#include "integrators/implicit/multigrid_solver.h"

namespace cloth::solvers {
namespace {

class JacobiSubject : public LinearSubject {
 public:
  explicit JacobiSubject(const NewtonSystem& system) : system_(system) {}
  std::string name() const override { return "conjugate gradients, block Jacobi"; }
  bool set_up() override {
    jacobi_.prepare(system_.system, system_.matrix);
    return true;
  }
  int solve(double tolerance, Vec3Field& solution) override {
    const KrylovReport report = gradients_.solve(system_.system, system_.matrix, jacobi_,
                                                 system_.right_hand_side, tolerance, solution);
    return report.converged ? report.iterations : -1;
  }

 private:
  const NewtonSystem& system_;
  BlockJacobi jacobi_;
  ConjugateGradients gradients_;
};

class MultigridSubject : public LinearSubject {
 public:
  explicit MultigridSubject(const NewtonSystem& system) : system_(system) {}
  std::string name() const override { return "conjugate gradients, multigrid"; }
  /// Of a mesh its pattern and aggregates, with the numbers of a first cycle.
  bool analyse() override {
    return system_.system.is_mesh() &&
           MultigridSolver().prepare(system_.system, system_.clamped, system_.position);
  }
  bool set_up() override { return multigrid_.prepare(system_.system, system_.clamped, system_.position); }
  int solve(double tolerance, Vec3Field& solution) override {
    const LinearMap cycle = [this](const Vec3Field& in, Vec3Field& out) { multigrid_.precondition(in, out); };
    const KrylovReport report =
        gradients_.solve(system_.system, system_.matrix, cycle, system_.right_hand_side, tolerance, solution);
    return report.converged ? report.iterations : -1;
  }

 private:
  const NewtonSystem& system_;
  MultigridSolver multigrid_;
  ConjugateGradients gradients_;
};

class FactorsSubject : public LinearSubject {
 public:
  explicit FactorsSubject(const NewtonSystem& system) : system_(system) {}
  std::string name() const override { return "Cholesky factors by fronts"; }
  bool is_direct() const override { return true; }
  bool analyse() override {
    BlockCholesky factors(3);
    analyse_free_rows(system_.system, free_rows(system_.system), factors);
    return true;
  }
  /// Gathering the blocks is part of it.
  bool set_up() override { return factors_.factorise(system_.system, system_.matrix); }
  int solve(double, Vec3Field& solution) override {
    factors_.solve(system_.right_hand_side, solution);
    return 0;
  }

 private:
  const NewtonSystem& system_;
  CholeskyFactors factors_;
};

}  // namespace

Subjects our_subjects(const NewtonSystem& system) {
  Subjects subjects;
  subjects.push_back(std::make_unique<MultigridSubject>(system));
  subjects.push_back(std::make_unique<JacobiSubject>(system));
  subjects.push_back(std::make_unique<FactorsSubject>(system));
  return subjects;
}

}  // namespace cloth::solvers
