#include "geometry/builtin_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "geometry/bunny.h"
#include "geometry/split_mix.h"

namespace cloth {
namespace {

using std::numbers::pi;

TriangleMesh bunny() {
  return make_bunny(0.0087);
}

/// A plate of 1 m by 1 m with 8 x 8 cones on it, their bases on y = 0.
class ConeBed {
 public:
  TriangleMesh make() {
    for (int row = 0; row < cones; ++row)
      for (int column = 0; column < cones; ++column) add_cone(row, column);
    add_plate();
    return std::move(mesh_);
  }

 private:
  static constexpr int cones = 8;  // along a side
  static constexpr int around = 24;
  static constexpr double pitch = 1.0 / cones, radius = 0.42 * pitch, tip = 0.15, thickness = 0.03;  // m

  int add(const Vec3& vertex) {
    mesh_.vertices.push_back(vertex);
    return static_cast<int>(mesh_.vertices.size()) - 1;
  }

  /// The corner k of the square of side 1 about the origin, seen from its middle at k equal angles.
  static Eigen::Vector2d on_square(int k) {
    const double angle = 2 * pi * k / around;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const double longest = direction.cwiseAbs().maxCoeff();
    Eigen::Vector2d point = 0.5 * direction / longest;
    for (double& coordinate : point)  // neighbours must meet to the bit
      coordinate = std::round(coordinate * 1e6) / 1e6;
    return point;
  }

  void add_cone(int row, int column) {
    const Vec3 middle((column + 0.5) * pitch - 0.5, 0, (row + 0.5) * pitch - 0.5);
    const int apex = add(middle + Vec3(0, tip, 0));
    std::array<int, around> ring{}, rim{};
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * pi * k / around;
      ring[k] = add(middle + radius * Vec3(std::cos(angle), 0, std::sin(angle)));
      const Eigen::Vector2d at = on_square(k);
      rim[k] = add({(column + (0.5 + at.x())) * pitch - 0.5, 0, (row + (0.5 + at.y())) * pitch - 0.5});
    }
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      mesh_.triangles.push_back({apex, ring[next], ring[k]});
      mesh_.triangles.push_back({ring[k], ring[next], rim[next]});
      mesh_.triangles.push_back({ring[k], rim[next], rim[k]});
    }
  }

  /// Walls down from the border, and the underside.
  void add_plate() {
    const int middle = add({0, -thickness, 0});
    for (int side = 0; side < 4; ++side)
      for (int cone = 0; cone < cones; ++cone)
        for (int k = -around / 8; k < around / 8; ++k) {
          const Vec3 from = on_border(side, cone, k), to = on_border(side, cone, k + 1),
                     down(0, -thickness, 0);
          const int a = add(from), b = add(to), c = add(to + down), d = add(from + down);
          mesh_.triangles.push_back({a, b, c});
          mesh_.triangles.push_back({a, c, d});
          mesh_.triangles.push_back({middle, d, c});
        }
  }

  /// Along the border anticlockwise as seen from below: with x, with z, against x, against z.
  static Vec3 on_border(int side, int cone, int k) {
    const double along = on_square((k + around) % around).y();
    const int place = side < 2 ? cone : cones - 1 - cone;
    const double s = (place + (0.5 + (side < 2 ? along : -along))) * pitch - 0.5;
    switch (side) {
      case 0:
        return {s, 0, -0.5};
      case 1:
        return {0.5, 0, s};
      case 2:
        return {s, 0, 0.5};
      default:
        return {-0.5, 0, s};
    }
  }

  TriangleMesh mesh_;
};

TriangleMesh cone_bed() {
  return ConeBed().make();
}

/// A number in [-1, 1) for each k.
double scatter(std::uint64_t k) {
  return SplitMix(k).number();
}

/// A round cloth of diameter 1 m in the plane y = 0, facing up: rings of 6, 12, 18, ... vertices about its
/// middle, all but the last one scattered by up to a fifth of their distance.
TriangleMesh disc() {
  constexpr int rings = 24;
  constexpr double radius = 0.5, spacing = radius / rings, scattering = 0.2;  // m, m, of the spacing
  TriangleMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  const auto first_of = [](int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  for (int ring = 1; ring <= rings; ++ring)
    for (int k = 0; k < 6 * ring; ++k) {
      const auto number = static_cast<std::uint64_t>(mesh.vertices.size());
      const double loose = ring < rings ? scattering : 0;
      const double r = (ring + loose * scatter(2 * number)) * spacing;
      const double angle = 2 * pi * (k + loose * scatter(2 * number + 1)) / (6 * ring);
      mesh.vertices.push_back({r * std::cos(angle), 0, -r * std::sin(angle)});
    }
  // Between two rings each of six sectors is a strip: `ring` steps outside for ring - 1 inside.
  for (int ring = 1; ring <= rings; ++ring)
    for (int sector = 0; sector < 6; ++sector)
      for (int k = 0; k < ring; ++k) {
        const auto outer = [&](int step) { return first_of(ring) + (sector * ring + step) % (6 * ring); };
        const auto inner = [&](int step) {
          return ring == 1 ? 0 : first_of(ring - 1) + (sector * (ring - 1) + step) % (6 * (ring - 1));
        };
        mesh.triangles.push_back({inner(k), outer(k), outer(k + 1)});
        if (k + 1 < ring) mesh.triangles.push_back({inner(k), outer(k + 1), inner(k + 1)});
      }
  return mesh;
}

}  // namespace

const std::vector<BuiltinMesh>& builtin_meshes() {
  static const std::vector<BuiltinMesh> all{
      {"bunny.obj", "A sitting rabbit, 1 m high", bunny},
      {"cone-bed.obj", "64 cones on a plate of 1 m by 1 m", cone_bed},
      {"disc.obj", "A round cloth, 1 m across, of irregular triangles", disc},
  };
  return all;
}

const BuiltinMesh* find_builtin_mesh(const std::string& name) {
  const auto& meshes = builtin_meshes();
  const auto found =
      std::find_if(meshes.begin(), meshes.end(), [&](const BuiltinMesh& mesh) { return mesh.name == name; });
  return found == meshes.end() ? nullptr : &*found;
}

}  // namespace cloth
