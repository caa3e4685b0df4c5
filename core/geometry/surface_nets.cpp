#include "geometry/surface_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cloth {
namespace {

constexpr int block = 8;  // cells along a side
using Cell = std::array<int, 3>;

class SurfaceNets {
 public:
  SurfaceNets(const DistanceFunction& distance, const Eigen::AlignedBox3d& bounds, double cell)
      : distance_(distance), corner_(bounds.min()), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis)
      cells_[axis] = block * static_cast<int>(std::ceil(bounds.sizes()[axis] / (block * cell)));
    const std::size_t nodes = node(cells_) + 1;
    value_.assign(nodes, far);
    vertex_.assign(nodes, -1);
  }

  TriangleMesh make() {
    sample();
    for_each_cell([&](const Cell& c) { place_vertex(c); });
    for_each_cell([&](const Cell& c) {
      for (std::size_t axis = 0; axis < 3; ++axis) join_around_edge(c, axis);
    });
    return std::move(mesh_);
  }

 private:
  static constexpr double far = 1e9;
  static constexpr double margin = 0.03;  // of a cell

  std::size_t node(const Cell& c) const {
    const auto along = [&](std::size_t axis) { return static_cast<std::size_t>(cells_[axis] + 1); };
    return (static_cast<std::size_t>(c[1]) * along(2) + static_cast<std::size_t>(c[2])) * along(0) +
           static_cast<std::size_t>(c[0]);
  }
  Vec3 place(const Cell& c) const { return corner_ + cell_ * Vec3(c[0], c[1], c[2]); }

  template <class Visit>
  void for_each_cell(Visit visit) const {
    for (int y = 0; y < cells_[1]; ++y)
      for (int z = 0; z < cells_[2]; ++z)
        for (int x = 0; x < cells_[0]; ++x) visit(Cell{x, y, z});
  }

  /// Values at the corners of the blocks that the surface may pass.
  void sample() {
    const double reach = std::sqrt(3.0) * block * cell_;  // twice from a block's middle to its corner
    for (int y = 0; y < cells_[1]; y += block)
      for (int z = 0; z < cells_[2]; z += block)
        for (int x = 0; x < cells_[0]; x += block) {
          const Vec3 middle = place({x, y, z}) + Vec3::Constant(0.5 * block * cell_);
          if (std::abs(distance_(middle)) > reach) continue;
          for (int j = y; j <= y + block; ++j)
            for (int k = z; k <= z + block; ++k)
              for (int i = x; i <= x + block; ++i)
                if (double& value = value_[node({i, j, k})]; value == far)
                  value = distance_(place({i, j, k}));
        }
  }

  static Cell corner_of(const Cell& c, int k) {
    return {c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)};
  }

  /// The middle of the places where the surface cuts the cell's edges, moved onto the surface; but not so
  /// near to a neighbouring cell that triangles could become needles.
  void place_vertex(const Cell& c) {
    Vec3 sum = Vec3::Zero();
    int cuts = 0;
    for (int k = 0; k < 8; ++k)
      for (const int axis : {1, 2, 4}) {
        if (k & axis) continue;
        const Cell from = corner_of(c, k), to = corner_of(c, k | axis);
        const double a = value_[node(from)], b = value_[node(to)];
        if (a == far || b == far || (a < 0) == (b < 0)) continue;
        sum += place(from) + a / (a - b) * (place(to) - place(from));
        ++cuts;
      }
    if (cuts == 0) return;
    vertex_[node(c)] = static_cast<int>(mesh_.vertices.size());
    const Vec3 middle = place(c) + Vec3::Constant(0.5 * cell_), most = Vec3::Constant((0.5 - margin) * cell_);
    mesh_.vertices.push_back(on_surface(sum / cuts).cwiseMax(middle - most).cwiseMin(middle + most));
  }

  /// One step of Newton's method along the gradient, at most a quarter of a cell.
  Vec3 on_surface(const Vec3& x) const {
    const double d = distance_(x), step = 0.01 * cell_;
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis)
      gradient[axis] =
          (distance_(x + step * Vec3::Unit(axis)) - distance_(x - step * Vec3::Unit(axis))) / (2 * step);
    const double squared = gradient.squaredNorm();
    if (!(squared > 0)) return x;
    const Vec3 move = -d / squared * gradient;
    return x + std::min(1.0, 0.25 * cell_ / std::max(move.norm(), 1e-30)) * move;
  }

  /// The four cells around the edge from `c` along `axis`, if the surface cuts it.
  void join_around_edge(const Cell& c, std::size_t axis) {
    Cell to = c;
    ++to[axis];
    const double a = value_[node(c)], b = value_[node(to)];
    if (a == far || b == far || (a < 0) == (b < 0)) return;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (c[u] == 0 || c[v] == 0) return;
    std::array<int, 4> corner{};
    const std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t k = 0; k < 4; ++k) {
      Cell cell = c;
      cell[u] -= around[k][0], cell[v] -= around[k][1];
      corner[k] = vertex_[node(cell)];
    }
    if (!(a < 0)) std::swap(corner[1], corner[3]);
    const auto at = [&](std::size_t k) -> const Vec3& {
      return mesh_.vertices[static_cast<std::size_t>(corner[k])];
    };
    const std::size_t first = (at(0) - at(2)).squaredNorm() <= (at(1) - at(3)).squaredNorm() ? 0 : 1;
    const auto turned = [&](std::size_t k) { return corner[(first + k) % 4]; };
    mesh_.triangles.push_back({turned(0), turned(1), turned(2)});
    mesh_.triangles.push_back({turned(0), turned(2), turned(3)});
  }

  const DistanceFunction& distance_;
  Vec3 corner_;
  double cell_;
  Cell cells_{};
  std::vector<double> value_;
  std::vector<int> vertex_;  ///< of the cell whose lowest corner is the node
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh surface_nets(const DistanceFunction& distance, const Eigen::AlignedBox3d& bounds, double cell) {
  return SurfaceNets(distance, bounds, cell).make();
}

}  // namespace cloth
