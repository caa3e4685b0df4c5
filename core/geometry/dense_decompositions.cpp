#include "geometry/dense_decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace cloth {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using Solver = Eigen::SelfAdjointEigenSolver<MatrixXd>;

}  // namespace

SymmetricModes symmetric_modes(const MatrixXd& matrix) {
  const Solver solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd symmetric_values(const MatrixXd& matrix) {
  return Solver(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

VectorXd tridiagonal_values(const VectorXd& main, const VectorXd& beside) {
  Solver solver;
  solver.computeFromTridiagonal(main, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

std::optional<MatrixXd> cholesky_factor(const MatrixXd& matrix) {
  const Eigen::LLT<MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) return std::nullopt;
  return factors.matrixL();
}

std::optional<MatrixXd> positive_inverse(const MatrixXd& matrix) {
  const Eigen::LLT<MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) return std::nullopt;
  MatrixXd inverse = factors.solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
  if (!inverse.allFinite()) return std::nullopt;
  return inverse;
}

SingularParts singular_parts(const MatrixXd& matrix) {
  const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

double spectral_norm(const MatrixXd& matrix) {
  return Eigen::JacobiSVD<MatrixXd>(matrix).singularValues()[0];
}

MatrixXd shortest_least_squares(const MatrixXd& matrix, const MatrixXd& data) {
  return matrix.completeOrthogonalDecomposition().solve(data);
}

}  // namespace cloth
