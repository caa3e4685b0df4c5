#include <HYPRE.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>
#include <HYPRE_utilities.h>

#include <numeric>

#include "bench/solvers/linear_subject.h"

namespace cloth::solvers {
namespace {

/// MPI with this process alone, from the first use to the end of the program.
struct Mpi {
  Mpi() {
    MPI_Init(nullptr, nullptr);
    HYPRE_Init();
  }
  ~Mpi() {
    HYPRE_Finalize();
    MPI_Finalize();
  }
};

void begin_mpi() {
  static const Mpi mpi;
}

/// How BoomerAMG treats the three components of a particle.
struct AmgChoice {
  const char* name;
  int functions;         ///< 1: as if they were unknowns of one function
  int nodal;             ///< 0: each component is coarsened for itself; 1: particles, by Frobenius norms
  double strong;         ///< threshold of strong couplings
  int coarsening;        ///< 8: PMIS, 10: HMIS, 6: Falgout
  int interpolation;     ///< 6: extended+i, 0: classical
  int truncation_width;  ///< most numbers in a row of an interpolation
};

class BoomerSubject : public LinearSubject {
 public:
  BoomerSubject(const NewtonSystem& system, const AmgChoice& choice)
      : system_(system), choice_(choice), pattern_(system.system) {
    begin_mpi();
    const int last = pattern_.rows().rows() - 1;
    HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, last, 0, last, &ij_);
    HYPRE_IJMatrixSetObjectType(ij_, HYPRE_PARCSR);
    make_vector(right_ij_, right_);
    make_vector(solution_ij_, solution_);
    indices_.resize(static_cast<std::size_t>(last) + 1);
    std::iota(indices_.begin(), indices_.end(), 0);
    convert();
  }
  BoomerSubject(const BoomerSubject&) = delete;
  BoomerSubject& operator=(const BoomerSubject&) = delete;
  ~BoomerSubject() override {
    if (amg_) HYPRE_BoomerAMGDestroy(amg_);
    if (gradients_) HYPRE_ParCSRPCGDestroy(gradients_);
    HYPRE_IJMatrixDestroy(ij_);
    HYPRE_IJVectorDestroy(right_ij_);
    HYPRE_IJVectorDestroy(solution_ij_);
  }

  std::string name() const override { return std::string("hypre, BoomerAMG, ") + choice_.name; }
  std::string library() const override { return "hypre " HYPRE_RELEASE_VERSION; }

  bool convert() override {
    const SparseRows& rows = pattern_.fill(system_.system, system_.matrix);
    std::vector<int> counts;
    for (std::size_t row = 0; row + 1 < rows.begin.size(); ++row)
      counts.push_back(rows.begin[row + 1] - rows.begin[row]);
    HYPRE_IJMatrixInitialize(ij_);
    HYPRE_IJMatrixSetValues(ij_, rows.rows(), counts.data(), indices_.data(), rows.column.data(),
                            rows.value.data());
    HYPRE_IJMatrixAssemble(ij_);
    void* object = nullptr;
    HYPRE_IJMatrixGetObject(ij_, &object);
    matrix_ = static_cast<HYPRE_ParCSRMatrix>(object);
    return true;
  }

  bool set_up() override {
    if (amg_) HYPRE_BoomerAMGDestroy(amg_);
    if (gradients_) HYPRE_ParCSRPCGDestroy(gradients_);
    HYPRE_BoomerAMGCreate(&amg_);
    HYPRE_BoomerAMGSetPrintLevel(amg_, 0);
    HYPRE_BoomerAMGSetNumFunctions(amg_, choice_.functions);
    HYPRE_BoomerAMGSetNodal(amg_, choice_.nodal);
    HYPRE_BoomerAMGSetStrongThreshold(amg_, choice_.strong);
    HYPRE_BoomerAMGSetCoarsenType(amg_, choice_.coarsening);
    HYPRE_BoomerAMGSetInterpType(amg_, choice_.interpolation);
    HYPRE_BoomerAMGSetPMaxElmts(amg_, choice_.truncation_width);
    HYPRE_BoomerAMGSetRelaxType(amg_, 6);  // symmetric Gauss-Seidel
    HYPRE_BoomerAMGSetNumSweeps(amg_, 1);
    HYPRE_BoomerAMGSetMaxIter(amg_, 1);
    HYPRE_BoomerAMGSetTol(amg_, 0);
    HYPRE_ParCSRPCGCreate(MPI_COMM_SELF, &gradients_);
    HYPRE_PCGSetTwoNorm(gradients_, 1);
    HYPRE_PCGSetMaxIter(gradients_, 2000);
    HYPRE_PCGSetPrecond(gradients_, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
                        reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), amg_);
    HYPRE_ParCSRPCGSetup(gradients_, matrix_, right_, solution_);
    return !has_failed();
  }

  int solve(double tolerance, Vec3Field& solution) override {
    const std::vector<double> right = packed(pattern_.rows(), system_.right_hand_side);
    values_.assign(right.size(), 0);
    const auto count = static_cast<int>(right.size());
    HYPRE_IJVectorSetValues(right_ij_, count, indices_.data(), right.data());
    HYPRE_IJVectorSetValues(solution_ij_, count, indices_.data(), values_.data());
    HYPRE_PCGSetTol(gradients_, tolerance);
    HYPRE_ParCSRPCGSolve(gradients_, matrix_, right_, solution_);
    HYPRE_IJVectorGetValues(solution_ij_, count, indices_.data(), values_.data());
    unpack(pattern_.rows(), values_, solution);
    int iterations = 0;
    HYPRE_PCGGetNumIterations(gradients_, &iterations);
    return has_failed() ? -1 : iterations;
  }

 private:
  bool has_failed() const {
    const bool failed = HYPRE_GetError() != 0;
    HYPRE_ClearAllErrors();
    return failed;
  }

  void make_vector(HYPRE_IJVector& ij, HYPRE_ParVector& vector) const {
    HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, pattern_.rows().rows() - 1, &ij);
    HYPRE_IJVectorSetObjectType(ij, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(ij);
    HYPRE_IJVectorAssemble(ij);
    void* object = nullptr;
    HYPRE_IJVectorGetObject(ij, &object);
    vector = static_cast<HYPRE_ParVector>(object);
  }

  const NewtonSystem& system_;
  AmgChoice choice_;
  RowPattern pattern_;
  std::vector<int> indices_;
  std::vector<double> values_;
  HYPRE_IJMatrix ij_ = nullptr;
  HYPRE_ParCSRMatrix matrix_ = nullptr;
  HYPRE_IJVector right_ij_ = nullptr, solution_ij_ = nullptr;
  HYPRE_ParVector right_ = nullptr, solution_ = nullptr;
  HYPRE_Solver amg_ = nullptr, gradients_ = nullptr;
};

}  // namespace

Subjects hypre_subjects(const NewtonSystem& system) {
  static constexpr AmgChoice choices[] = {
      {"components", 3, 0, 0.25, 10, 6, 4},
      {"nodal", 3, 1, 0.25, 10, 6, 4},
  };
  Subjects subjects;
  for (const AmgChoice& choice : choices) subjects.push_back(std::make_unique<BoomerSubject>(system, choice));
  return subjects;
}

}  // namespace cloth::solvers
