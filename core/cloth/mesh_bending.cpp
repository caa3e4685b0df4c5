#include "cloth/mesh_bending.h"

#include <algorithm>
#include <cmath>

#include "cloth/mesh_patch.h"
#include "geometry/dense_decompositions.h"

namespace cloth {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// What a weighted sum of vertices' positions is made of.
struct WeightedVertices {
  std::vector<int> vertex;
  MatrixXd weight;  ///< a column for each vertex

  explicit WeightedVertices(Index rows) : weight(rows, 0) {}

  Index column_of(int v) {
    const auto found = std::find(vertex.begin(), vertex.end(), v);
    if (found != vertex.end()) return found - vertex.begin();
    vertex.push_back(v);
    weight.conservativeResize(Eigen::NoChange, weight.cols() + 1);
    weight.col(weight.cols() - 1).setZero();
    return weight.cols() - 1;
  }
  template <class Vertices>
  void add(const Eigen::VectorXd& direction, const Vertices& vertices, const Eigen::RowVectorXd& weights) {
    for (std::size_t v = 0; v < vertices.size(); ++v)
      weight.col(column_of(vertices[v])) += weights[static_cast<Index>(v)] * direction;
  }
};

class CurvatureBuilder {
 public:
  CurvatureBuilder(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned, const PlaneAxes& axes,
                   const Eigen::Vector3d& weight)
      : weight_(weight), neighbours_(neighbours_of(mesh.triangles)) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corner = mesh.triangles[t];
      const auto is_pinned = [&](int c) { return pinned[at(c)] != 0; };
      stands_.push_back(std::all_of(corner.begin(), corner.end(), is_pinned));
      triangle_.push_back(flat_triangle(mesh, corner, axes.in(mesh, corner)));
      const bool has_surface = triangle_[t].area > 0 && !stands_[t];
      surface_.push_back(has_surface ? patch_surface(mesh, pinned, triangle_[t], neighbours_[t], weight)
                                     : PatchSurface());
    }
  }

  bool bends(std::size_t t) const { return triangle_[t].area > 0 && !stands_[t]; }
  double area_of(std::size_t t) const { return triangle_[t].area; }

  /// Rows k_11, k_22, k_12 of triangle t. An edge's slope adds along n n^T; those of free edges are what
  /// takes the least energy.
  WeightedVertices curvature_of(std::size_t t) const {
    const FlatTriangle& triangle = triangle_[t];
    const Eigen::Matrix<double, 2, 3> plane = triangle.slope();
    WeightedVertices curvature(3);
    MatrixXd free(3, 0);
    for (std::size_t e = 0; e < 3; ++e) {
      const Eigen::Vector2d n = triangle.outward_of(e);
      const Eigen::Vector3d direction = triangle.length_of(e) / triangle.area *
                                        Eigen::Vector3d(n.x() * n.x(), n.y() * n.y(), n.x() * n.y());
      const AcrossEdge& across = neighbours_[t][e];
      if (across.triangle < 0 || !(triangle_[at(across.triangle)].area > 0)) {
        free.conservativeResize(Eigen::NoChange, free.cols() + 1);
        free.col(free.cols() - 1) = direction;
        continue;
      }
      curvature.add(direction, triangle.corner, -n.transpose() * plane);
      add_shared_slope(t, e, across, direction, curvature);
    }
    if (free.cols() > 0) {
      const MatrixXd root = weight_.cwiseSqrt().asDiagonal();
      curvature.weight -=
          free * (root * free).completeOrthogonalDecomposition().solve(root * curvature.weight);
    }
    return curvature;
  }

 private:
  /// The other triangle's outward direction is this one's inward.
  void add_shared_slope(std::size_t t, std::size_t e, const AcrossEdge& across,
                        const Eigen::Vector3d& direction, WeightedVertices& curvature) const {
    const std::size_t o = at(across.triangle), f = at(across.edge);
    const FlatTriangle& other = triangle_[o];
    if (stands_[o]) {
      curvature.add(direction, other.corner, -other.outward_of(f).transpose() * other.slope());
      return;
    }
    const PatchSurface &mine = surface_[t], &its = surface_[o];
    curvature.add(0.5 * direction, mine.corner,
                  mine.slope_at(triangle_[t].middle_of(e), triangle_[t].outward_of(e)));
    curvature.add(-0.5 * direction, its.corner, its.slope_at(other.middle_of(f), other.outward_of(f)));
  }

  const Eigen::Vector3d weight_;
  TriangleNeighbours neighbours_;
  std::vector<bool> stands_;
  std::vector<FlatTriangle> triangle_;
  std::vector<PatchSurface> surface_;
};

/// Elements whose energies sum up to 1/2 area x^T C^T W C x, C the curvatures: as few as there are.
void add_elements(const WeightedVertices& curvature, const Eigen::Vector3d& weight, double area,
                  BendingRuns& runs) {
  const MatrixXd form = weight.cwiseSqrt().asDiagonal() * curvature.weight;
  const auto [values, vectors] = symmetric_modes(form * form.transpose());
  const double largest = values.maxCoeff();
  for (Index k = 0; k < 3; ++k) {
    if (!(values[k] > 1e-12 * largest)) continue;
    const Eigen::VectorXd c = form.transpose() * vectors.col(k);
    const double unit = c.cwiseAbs().maxCoeff();
    BendingRun run{.first = 0, .count = 1, .points = static_cast<int>(curvature.vertex.size())};
    for (std::size_t p = 0; p < curvature.vertex.size(); ++p)
      run.offset[p] = curvature.vertex[p], run.coefficient[p] = c[static_cast<Index>(p)] / unit;
    run.stiffness = area * unit * unit;
    runs.push_back(run);
  }
}

/// About the normals of the triangle's own corners, which come first.
void add_slider(const WeightedVertices& curvature, Index row, double area, double stiffness, double yield,
                BendingSliders& sliders) {
  const Eigen::RowVectorXd weight = curvature.weight.row(row);
  if (!(yield > 0) || weight.size() == 0 || !(weight.cwiseAbs().maxCoeff() > 0)) return;
  BendingSlider slider{.points = static_cast<int>(curvature.vertex.size()),
                       .normal_points = 3,
                       .area = area,
                       .stiffness = stiffness,
                       .yield = yield};
  for (std::size_t p = 0; p < curvature.vertex.size(); ++p)
    slider.particle[p] = curvature.vertex[p], slider.coefficient[p] = weight[static_cast<Index>(p)];
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
  static_assert(BendingRun::most_points >= 12);  // a triangle, its neighbours and theirs
  const Eigen::Vector3d weight(bending.along_1, bending.along_2, 2 * bending.twist);
  MeshBending result;
  if (!(weight.maxCoeff() > 0)) return result;
  const CurvatureBuilder builder(mesh, pinned, axes, weight);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!builder.bends(t)) continue;
    const double area = builder.area_of(t);
    const WeightedVertices curvature = builder.curvature_of(t);
    add_elements(curvature, weight, area, result.elements);
    add_slider(curvature, 0, area, friction.stiffness_1, friction.yield_1, result.sliders);
    add_slider(curvature, 1, area, friction.stiffness_2, friction.yield_2, result.sliders);
  }
  return result;
}

}  // namespace cloth
