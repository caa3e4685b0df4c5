// A way to solve the linear systems of an implicit step, ours or a library's, in phases that are timed apart.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/solvers/newton_system.h"

namespace cloth::solvers {

class LinearSubject {
 public:
  virtual ~LinearSubject() = default;

  virtual std::string name() const = 0;
  /// "", or the library with its version.
  virtual std::string library() const { return ""; }
  /// Once for a pattern of couplings; false where there is nothing to do.
  virtual bool analyse() { return false; }
  /// From our blocks to the library's own numbers; false where there is nothing to do.
  virtual bool convert() { return false; }
  /// What is made anew for each matrix: factors, or a preconditioner. False: it cannot be.
  virtual bool set_up() = 0;
  /// Solves A x = b with a tolerance of the solver's own measure; direct ones have none. Iterations, or -1
  /// where it did not converge.
  virtual int solve(double tolerance, Vec3Field& solution) = 0;
  virtual bool is_direct() const { return false; }
};

using Subjects = std::vector<std::unique_ptr<LinearSubject>>;

/// Conjugate gradients with the inverses of the diagonal's blocks, the same with a cycle of multigrid, and
/// Cholesky factors by fronts. `system` must outlive them.
Subjects our_subjects(const NewtonSystem& system);

/// CHOLMOD, supernodal. Only in a build with it.
Subjects cholmod_subjects(const NewtonSystem& system);

/// Conjugate gradients of hypre with a cycle of BoomerAMG, for systems of three functions. Only in a build
/// with it.
Subjects hypre_subjects(const NewtonSystem& system);

}  // namespace cloth::solvers
