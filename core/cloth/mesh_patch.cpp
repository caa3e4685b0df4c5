#include "cloth/mesh_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "geometry/dense_decompositions.h"

namespace cloth {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Coefficients = Eigen::Matrix<double, 1, 6>;  ///< of 1, x, y, x^2/2, y^2/2, x y

Coefficients value_at(const Vector2d& p) {
  Coefficients row;
  row << 1, p.x(), p.y(), 0.5 * p.x() * p.x(), 0.5 * p.y() * p.y(), p.x() * p.y();
  return row;
}
/// Derivative along n.
Coefficients slope_at(const Vector2d& p, const Vector2d& n) {
  Coefficients row;
  row << 0, n.x(), n.y(), p.x() * n.x(), p.y() * n.y(), p.x() * n.y() + p.y() * n.x();
  return row;
}

/// What the surface of a patch has to meet: each row of `basis` of its six coefficients is a row of `data` of
/// the corners' positions. The first three rows are the triangle's own corners.
class PatchConditions {
 public:
  PatchConditions(const TriangleMesh& mesh, const FlatTriangle& triangle)
      : mesh_(mesh), triangle_(triangle), corner_(triangle.corner.begin(), triangle.corner.end()) {
    basis_.resize(6, 6), data_ = MatrixXd::Zero(6, 6);
    for (const std::size_t c : {0u, 1u, 2u}) {
      basis_.row(rows_) = value_at(triangle.place[c]);
      data_(rows_, rows_) = 1;
      ++rows_;
    }
  }

  void add_across(std::size_t e, int opposite, bool is_clamped) {
    const std::size_t begin = e, end = (e + 1) % 3;
    const Vec3 a = vertex(corner_[begin]), along = vertex(corner_[end]) - a, arm = vertex(opposite) - a;
    const double length = along.norm(), foot = arm.dot(along) / (length * length);
    const double height = (arm - foot * along).norm();
    if (!(height > 1e-9 * length)) return;
    const auto point = static_cast<Index>(corner_.size());
    const Vector2d from = triangle_.place[begin], edge = triangle_.place[end] - from;
    const Vector2d out = triangle_.outward_of(e);
    corner_.push_back(opposite);
    data_(rows_, point) = 1;
    if (is_clamped) {
      basis_.row(rows_) = height * slope_at(triangle_.middle_of(e), out);
      data_(rows_, static_cast<Index>(begin)) = foot - 1;
      data_(rows_, static_cast<Index>(end)) = -foot;
    } else {
      basis_.row(rows_) = value_at(from + foot * edge + height * out);
    }
    ++rows_;
  }

  /// The surface of least energy. The triangle's corners give its plane, so that nothing that is flat has
  /// any, however the patch is shaped; what there is to meet beside them gives the curvatures.
  PatchSurface solve(const Eigen::Vector3d& weight) const {
    const auto points = static_cast<Index>(corner_.size()), more = rows_ - 3;
    const Eigen::Matrix3d plane = basis_.topLeftCorner(3, 3).inverse(), bent = basis_.topRightCorner(3, 3);
    const MatrixXd by_plane = basis_.block(3, 0, more, 3) * plane;
    PatchSurface surface{.corner = corner_, .slope = {}, .curvature = {}};
    surface.curvature =
        least_energy(basis_.block(3, 3, more, 3) - by_plane * bent,
                     data_.block(3, 0, more, points) - by_plane * data_.topLeftCorner(3, points), weight);
    const MatrixXd flat = plane * (data_.topLeftCorner(3, points) - bent * surface.curvature);
    surface.slope = flat.bottomRows(2);
    return surface;
  }

 private:
  /// The curvatures with matrix * curvature = data, as far as that determines them.
  static MatrixXd least_energy(const MatrixXd& matrix, const MatrixXd& data, const Eigen::Vector3d& weight) {
    constexpr double undetermined = 1e-3;  // relative: a direction that the corners hardly tell apart
    if (matrix.rows() == 0) return MatrixXd::Zero(3, data.cols());
    const auto [left, values, right] = singular_parts(matrix);
    Index rank = 0;
    while (rank < values.size() && values[rank] > undetermined * values[0]) ++rank;
    const MatrixXd from = right.leftCols(rank) * values.head(rank).cwiseInverse().asDiagonal() *
                          left.leftCols(rank).transpose() * data;
    if (rank == 3) return from;
    const MatrixXd free = right.rightCols(3 - rank);
    const MatrixXd root = weight.cwiseSqrt().asDiagonal();
    return from - free * shortest_least_squares(root * free, root * from);
  }

  const Vec3& vertex(int i) const { return mesh_.vertices[at(i)]; }

  const TriangleMesh& mesh_;
  const FlatTriangle& triangle_;
  std::vector<int> corner_;
  MatrixXd basis_, data_;
  Index rows_ = 0;
};

}  // namespace

TriangleNeighbours neighbours_of(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, std::vector<AcrossEdge>> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t e = 0; e < 3; ++e)
      sides[std::minmax({triangles[t][e], triangles[t][(e + 1) % 3]})].push_back(
          {static_cast<int>(t), static_cast<int>(e)});
  TriangleNeighbours neighbours(triangles.size());
  for (const auto& [edge, of] : sides) {
    if (of.size() != 2) continue;
    for (const std::size_t one : {0u, 1u}) neighbours[at(of[one].triangle)][at(of[one].edge)] = of[1 - one];
  }
  return neighbours;
}

Vector2d FlatTriangle::outward_of(std::size_t e) const {
  const Vector2d edge = place[(e + 1) % 3] - place[e];
  const Vector2d out = Vector2d(edge.y(), -edge.x()).normalized();
  return out.dot(place[(e + 2) % 3] - place[e]) > 0 ? Vector2d(-out) : out;
}

Eigen::Matrix<double, 2, 3> FlatTriangle::slope() const {
  Eigen::Matrix3d corners;
  for (const std::size_t c : {0u, 1u, 2u})
    corners.row(static_cast<Index>(c)) << 1, place[c].x(), place[c].y();
  return corners.inverse().bottomRows(2);
}

FlatTriangle flat_triangle(const TriangleMesh& mesh, const Triangle& triangle,
                           const std::array<Vec3, 2>& axes) {
  FlatTriangle flat{.corner = triangle, .place = {}, .area = 0.5 * mesh.area_normal(triangle).norm()};
  const auto vertex = [&](std::size_t c) { return mesh.vertices[at(triangle[c])]; };
  const Vec3 middle = (vertex(0) + vertex(1) + vertex(2)) / 3;
  for (const std::size_t c : {0u, 1u, 2u}) {
    const Vec3 arm = vertex(c) - middle;
    flat.place[c] = Vector2d(arm.dot(axes[0]), arm.dot(axes[1]));
  }
  return flat;
}

Eigen::RowVectorXd PatchSurface::slope_at(const Vector2d& place, const Vector2d& direction) const {
  const Coefficients row = cloth::slope_at(place, direction);
  return row.segment<2>(1) * slope + row.tail<3>() * curvature;
}

PatchSurface patch_surface(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned,
                           const FlatTriangle& triangle, const std::array<AcrossEdge, 3>& across,
                           const Eigen::Vector3d& weight) {
  PatchConditions conditions(mesh, triangle);
  for (std::size_t e = 0; e < 3; ++e) {
    if (across[e].triangle < 0) continue;
    const Triangle& other = mesh.triangles[at(across[e].triangle)];
    const auto is_pinned = [&](int corner) { return pinned[at(corner)] != 0; };
    conditions.add_across(e, other[(at(across[e].edge) + 2) % 3],
                          std::all_of(other.begin(), other.end(), is_pinned));
  }
  return conditions.solve(weight);
}

}  // namespace cloth
