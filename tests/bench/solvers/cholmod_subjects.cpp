#include <dlfcn.h>
#include <suitesparse/cholmod.h>

#include <algorithm>
#include <cstring>

#include "bench/solvers/linear_subject.h"

namespace cloth::solvers {
namespace {

/// "OpenBLAS ..." or where the functions of BLAS come from.
std::string blas_name() {
  using Config = char* (*)();
  if (const auto config = reinterpret_cast<Config>(dlsym(RTLD_DEFAULT, "openblas_get_config"))) {
    const std::string text = config();
    return text.substr(0, text.find(' ', text.find(' ') + 1));
  }
  Dl_info info{};
  void* function = dlsym(RTLD_DEFAULT, "dgemm_");
  if (function && dladdr(function, &info) && info.dli_fname) {
    const std::string file = info.dli_fname;
    return file.substr(file.rfind('/') + 1);
  }
  return "BLAS";
}

class CholmodSubject : public LinearSubject {
 public:
  explicit CholmodSubject(const NewtonSystem& system) : system_(system), pattern_(system.system) {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
    common_.print = 0;
    const SparseRows& rows = pattern_.rows();
    const auto n = static_cast<std::size_t>(rows.rows());
    for (std::size_t row = 0; row < n; ++row)
      for (int at = rows.begin[row]; at < rows.begin[row + 1]; ++at)
        if (rows.column[static_cast<std::size_t>(at)] >= static_cast<int>(row)) taken_.push_back(at);
    // The upper half by rows is the lower half by columns.
    matrix_ = cholmod_allocate_sparse(n, n, taken_.size(), 1, 1, -1, CHOLMOD_REAL, &common_);
    auto* begin = static_cast<int*>(matrix_->p);
    auto* index = static_cast<int*>(matrix_->i);
    std::size_t next = 0;
    for (std::size_t row = 0; row < n; ++row) {
      begin[row] = static_cast<int>(next);
      for (; next < taken_.size() && taken_[next] < rows.begin[row + 1]; ++next)
        index[next] = rows.column[static_cast<std::size_t>(taken_[next])];
    }
    begin[n] = static_cast<int>(next);
    right_ = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common_);
    convert();
    factor_ = cholmod_analyze(matrix_, &common_);
  }
  CholmodSubject(const CholmodSubject&) = delete;
  CholmodSubject& operator=(const CholmodSubject&) = delete;
  ~CholmodSubject() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_dense(&right_, &common_);
    cholmod_free_dense(&solution_, &common_);
    cholmod_free_dense(&scratch_, &common_);
    cholmod_free_dense(&scratch_more_, &common_);
    cholmod_free_sparse(&matrix_, &common_);
    cholmod_finish(&common_);
  }

  std::string name() const override { return "CHOLMOD, supernodal"; }
  std::string library() const override {
    return "CHOLMOD " + std::to_string(CHOLMOD_MAIN_VERSION) + "." + std::to_string(CHOLMOD_SUB_VERSION) +
           " with " + blas_name();
  }
  bool is_direct() const override { return true; }

  /// Of another factor than the one that is kept, so that phases can be timed in any order.
  bool analyse() override {
    cholmod_factor* factor = cholmod_analyze(matrix_, &common_);
    cholmod_free_factor(&factor, &common_);
    return true;
  }

  bool convert() override {
    const SparseRows& rows = pattern_.fill(system_.system, system_.matrix);
    auto* values = static_cast<double*>(matrix_->x);
    for (std::size_t k = 0; k < taken_.size(); ++k)
      values[k] = rows.value[static_cast<std::size_t>(taken_[k])];
    return true;
  }

  bool set_up() override {
    return cholmod_factorize(matrix_, factor_, &common_) != 0 && common_.status == CHOLMOD_OK;
  }

  int solve(double, Vec3Field& solution) override {
    const std::vector<double> right = packed(pattern_.rows(), system_.right_hand_side);
    std::copy(right.begin(), right.end(), static_cast<double*>(right_->x));
    if (!cholmod_solve2(CHOLMOD_A, factor_, right_, nullptr, &solution_, nullptr, &scratch_, &scratch_more_,
                        &common_))
      return -1;
    const auto* x = static_cast<const double*>(solution_->x);
    unpack(pattern_.rows(), {x, x + right.size()}, solution);
    return 0;
  }

 private:
  const NewtonSystem& system_;
  RowPattern pattern_;
  std::vector<int> taken_;  ///< numbers of the pattern on and above the diagonal
  cholmod_common common_{};
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *right_ = nullptr, *solution_ = nullptr, *scratch_ = nullptr, *scratch_more_ = nullptr;
};

}  // namespace

Subjects cholmod_subjects(const NewtonSystem& system) {
  Subjects subjects;
  subjects.push_back(std::make_unique<CholmodSubject>(system));
  return subjects;
}

}  // namespace cloth::solvers
