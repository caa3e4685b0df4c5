// Decompositions of small dense matrices of any size, by Eigen. Compiled here once: each takes a compiler as
// long as some thousand lines.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace cloth {

/// matrix = vectors diag(values) vectors^T; the values ascend, the vectors are columns of length one.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Of a symmetric matrix; its lower triangle is read.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& matrix);
/// The values alone, in a fraction of the time.
Eigen::VectorXd symmetric_values(const Eigen::MatrixXd& matrix);
/// The values of the symmetric matrix with this main diagonal, and these numbers beside it.
Eigen::VectorXd tridiagonal_values(const Eigen::VectorXd& main, const Eigen::VectorXd& beside);

/// Lower triangular L with L L^T = matrix; none where the symmetric matrix is not positive definite.
std::optional<Eigen::MatrixXd> cholesky_factor(const Eigen::MatrixXd& matrix);
/// The inverse of a symmetric, positive definite matrix; none where it is not that, or not finite.
std::optional<Eigen::MatrixXd> positive_inverse(const Eigen::MatrixXd& matrix);

/// matrix = left diag(values) right^T; the values descend. As many columns of `left` as values; `right` is
/// square, and its last columns are those that the matrix maps to zero.
struct SingularParts {
  Eigen::MatrixXd left;
  Eigen::VectorXd values;
  Eigen::MatrixXd right;
};

SingularParts singular_parts(const Eigen::MatrixXd& matrix);

/// The largest singular value.
double spectral_norm(const Eigen::MatrixXd& matrix);

/// Of all x with least |matrix x - data| the shortest; column by column.
Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& data);

}  // namespace cloth
