#include "cloth/mesh_bending.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace cloth {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr std::size_t most_points = BendingRun::most_points;

/// The corner across each edge of a triangle, that from corner e to corner e + 1; -1: none.
using Opposites = std::vector<std::array<int, 3>>;

Opposites opposite_corners(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, std::size_t>>> sides;
  const auto key = [](int a, int b) { return std::pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t e = 0; e < 3; ++e)
      sides[key(triangles[t][e], triangles[t][(e + 1) % 3])].emplace_back(t, e);
  Opposites opposite(triangles.size(), {-1, -1, -1});
  for (const auto& [edge, of] : sides) {
    if (of.size() != 2) continue;  // free, or where more than two meet
    for (const std::size_t one : {0u, 1u}) {
      const auto& [t, e] = of[one];
      const auto& [other, f] = of[1 - one];
      opposite[t][e] = triangles[other][(f + 2) % 3];
    }
  }
  return opposite;
}

/// The places of a patch's corners in the triangle's plane, and what the surface of the patch has to meet:
/// each row of `basis` of its six coefficients is a row of `data` of the corners' positions.
struct Patch {
  std::vector<int> corner;
  std::vector<Vector2d> place;
  MatrixXd basis, data;
};

/// 1, x, y, x^2/2, y^2/2, x y.
Eigen::Matrix<double, 1, 6> values_at(const Vector2d& p) {
  Eigen::Matrix<double, 1, 6> row;
  row << 1, p.x(), p.y(), 0.5 * p.x() * p.x(), 0.5 * p.y() * p.y(), p.x() * p.y();
  return row;
}
/// Derivative along n.
Eigen::Matrix<double, 1, 6> slopes_at(const Vector2d& p, const Vector2d& n) {
  Eigen::Matrix<double, 1, 6> row;
  row << 0, n.x(), n.y(), p.x() * n.x(), p.y() * n.y(), p.x() * n.y() + p.y() * n.x();
  return row;
}

class PatchBuilder {
 public:
  PatchBuilder(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned, const Triangle& triangle,
               const std::array<Vec3, 2>& axes)
      : mesh_(mesh), pinned_(pinned) {
    const Vec3 middle = (vertex(triangle[0]) + vertex(triangle[1]) + vertex(triangle[2])) / 3;
    for (const int c : triangle) {
      const Vec3 arm = vertex(c) - middle;
      patch_.corner.push_back(c);
      patch_.place.emplace_back(arm.dot(axes[0]), arm.dot(axes[1]));
    }
    patch_.basis.resize(6, 6), patch_.data = MatrixXd::Zero(6, 6);
    for (Index row = 0; row < 3; ++row) {
      patch_.basis.row(row) = values_at(patch_.place[static_cast<std::size_t>(row)]);
      patch_.data(row, row) = 1;
    }
    rows_ = 3;
  }

  void add_across(std::size_t e, int opposite) {
    const std::size_t begin = e, end = (e + 1) % 3;
    const Vec3 a = vertex(patch_.corner[begin]), along = vertex(patch_.corner[end]) - a;
    const Vec3 arm = vertex(opposite) - a;
    const double length = along.norm(), foot = arm.dot(along) / (length * length);
    const double height = (arm - foot * along).norm();
    if (!(length > 0) || !(height > 1e-9 * length)) return;
    const Vector2d from = patch_.place[begin], edge = patch_.place[end] - from;
    Vector2d out(edge.y(), -edge.x());
    out /= length;
    if (out.dot(patch_.place[(e + 2) % 3] - from) > 0) out = -out;
    const auto point = static_cast<Index>(patch_.corner.size());
    patch_.corner.push_back(opposite);
    patch_.place.push_back(from + foot * edge + height * out);
    if (is_clamped(begin, end, opposite)) {
      patch_.basis.row(rows_) = height * slopes_at(from + 0.5 * edge, out);
      patch_.data(rows_, static_cast<Index>(begin)) = foot - 1;
      patch_.data(rows_, static_cast<Index>(end)) = -foot;
    } else {
      patch_.basis.row(rows_) = values_at(patch_.place.back());
    }
    patch_.data(rows_, point) = 1;
    ++rows_;
  }

  Patch finish() {
    const auto points = static_cast<Index>(patch_.corner.size());
    patch_.basis = patch_.basis.topRows(rows_).eval();
    patch_.data = patch_.data.topLeftCorner(rows_, points).eval();
    return std::move(patch_);
  }

 private:
  const Vec3& vertex(int i) const { return mesh_.vertices[at(i)]; }
  bool is_clamped(std::size_t begin, std::size_t end, int opposite) const {
    return pinned_[at(patch_.corner[begin])] && pinned_[at(patch_.corner[end])] && pinned_[at(opposite)];
  }

  const TriangleMesh& mesh_;
  const std::vector<std::uint8_t>& pinned_;
  Patch patch_;
  Index rows_ = 0;
};

/// The curvatures k_11, k_22, k_12 of the surface of least energy, one row each, from the corners' positions.
/// The triangle's corners give the surface's plane, so that nothing that is flat has any, however the patch is
/// shaped; what the surface has to meet beside them gives the curvatures.
MatrixXd curvatures(const Patch& patch, const Eigen::Vector3d& weight) {
  constexpr double undetermined = 1e-3;  // relative: a direction that the corners hardly tell apart
  const auto points = static_cast<Index>(patch.corner.size()), rows = patch.basis.rows() - 3;
  if (rows == 0) return MatrixXd::Zero(3, points);
  const Eigen::Matrix3d flat = patch.basis.topLeftCorner(3, 3), bent = patch.basis.topRightCorner(3, 3);
  const MatrixXd by_plane = patch.basis.bottomLeftCorner(rows, 3) * flat.inverse();
  const MatrixXd matrix = patch.basis.bottomRightCorner(rows, 3) - by_plane * bent;
  const MatrixXd data = patch.data.bottomRows(rows) - by_plane * patch.data.topRows(3);
  const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  Index rank = 0;
  while (rank < values.size() && values[rank] > undetermined * values[0]) ++rank;
  const MatrixXd from = svd.matrixV().leftCols(rank) * values.head(rank).cwiseInverse().asDiagonal() *
                        svd.matrixU().leftCols(rank).transpose() * data;
  if (rank == 3) return from;
  const MatrixXd free = svd.matrixV().rightCols(3 - rank);
  const MatrixXd root = weight.cwiseSqrt().asDiagonal();
  return from - free * (root * free).completeOrthogonalDecomposition().solve(root * from);
}

/// Elements whose energies sum up to 1/2 area x^T C^T W C x, C the curvatures: as few as there are.
void add_elements(const Patch& patch, const MatrixXd& curvature, const Eigen::Vector3d& weight, double area,
                  BendingRuns& runs) {
  const MatrixXd form = weight.cwiseSqrt().asDiagonal() * curvature;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(form * form.transpose());
  const double largest = solver.eigenvalues().maxCoeff();
  for (Index k = 0; k < 3; ++k) {
    if (!(solver.eigenvalues()[k] > 1e-12 * largest)) continue;
    const Eigen::VectorXd c = form.transpose() * solver.eigenvectors().col(k);
    const double unit = c.cwiseAbs().maxCoeff();
    BendingRun run{.first = 0, .count = 1, .points = static_cast<int>(patch.corner.size())};
    for (std::size_t p = 0; p < patch.corner.size(); ++p)
      run.offset[p] = patch.corner[p], run.coefficient[p] = c[static_cast<Index>(p)] / unit;
    run.stiffness = area * unit * unit;
    runs.push_back(run);
  }
}

void add_slider(const Patch& patch, const Eigen::RowVectorXd& curvature, double area, double stiffness,
                double yield, BendingSliders& sliders) {
  if (!(yield > 0) || !(curvature.cwiseAbs().maxCoeff() > 0)) return;
  BendingSlider slider{.points = static_cast<int>(patch.corner.size()),
                       .normal_points = 3,
                       .area = area,
                       .stiffness = stiffness,
                       .yield = yield};
  for (std::size_t p = 0; p < patch.corner.size(); ++p)
    slider.particle[p] = patch.corner[p], slider.coefficient[p] = curvature[static_cast<Index>(p)];
  sliders.push_back(slider);
}

}  // namespace

std::array<Vec3, 2> PlaneAxes::in(const TriangleMesh& mesh, const Triangle& triangle) const {
  constexpr double across = 1e-3;  // sine of the angle to the normal below which a direction says nothing
  const Vec3 n = mesh.area_normal(triangle).normalized();
  const Vec3 one = first - first.dot(n) * n, two = second - second.dot(n) * n;
  if (one.norm() > across) return {one.normalized(), n.cross(one).normalized()};
  return {two.cross(n).normalized(), two.normalized()};
}

MeshBending mesh_bending(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned,
                         const PlaneAxes& axes, const PlaneBending& bending, const PlaneFriction& friction) {
  const Eigen::Vector3d weight(bending.along_1, bending.along_2, 2 * bending.twist);
  MeshBending result;
  if (!(weight.maxCoeff() > 0)) return result;
  const Opposites opposite = opposite_corners(mesh.triangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const double area = 0.5 * mesh.area_normal(triangle).norm();
    const auto is_pinned = [&](int corner) { return pinned[at(corner)] != 0; };
    if (!(area > 0) || std::all_of(triangle.begin(), triangle.end(), is_pinned)) continue;
    PatchBuilder builder(mesh, pinned, triangle, axes.in(mesh, triangle));
    for (std::size_t e = 0; e < 3; ++e)
      if (opposite[t][e] >= 0) builder.add_across(e, opposite[t][e]);
    const Patch patch = builder.finish();
    static_assert(most_points >= 6);
    const MatrixXd curvature = curvatures(patch, weight);
    add_elements(patch, curvature, weight, area, result.elements);
    add_slider(patch, curvature.row(0), area, friction.stiffness_1, friction.yield_1, result.sliders);
    add_slider(patch, curvature.row(1), area, friction.stiffness_2, friction.yield_2, result.sliders);
  }
  return result;
}

}  // namespace cloth
