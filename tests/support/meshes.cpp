#include "support/meshes.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <tuple>

#include "geometry/at.h"
#include "support/direct_run.h"
#include "support/scenes.h"

namespace cloth::test {
namespace {

constexpr double particle_mass = 1e-3;  // kg

using Triangle = std::array<int, 3>;

std::vector<Triangle> triangles_of(int rows, int columns, Random& random) {
  std::vector<Triangle> triangles;
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (random.coin()) {
        triangles.push_back({a, b, e});
        triangles.push_back({a, e, d});
      } else {
        triangles.push_back({a, b, d});
        triangles.push_back({b, e, d});
      }
    }
  return triangles;
}

}  // namespace

ClothSystem mesh_system(const Vec3Field& start, const std::vector<MeshSpring>& springs,
                        const std::vector<int>& pinned) {
  ClothSystem system;
  system.rows = 1;
  system.columns = static_cast<int>(start.size());
  system.start = start;
  system.mass.assign(start.size(), particle_mass);
  system.inverse_mass.assign(start.size(), 1 / particle_mass);
  system.pinned.assign(start.size(), 0);
  for (const int i : pinned) {
    system.pinned[static_cast<std::size_t>(i)] = 1;
    system.inverse_mass[static_cast<std::size_t>(i)] = 0;
  }
  for (const SpringFamily family : spring_families)
    for (const MeshSpring& s : springs)
      if (s.family == family)
        system.springs.push_back(
            {family, std::min(s.i, s.j), 1, std::abs(s.j - s.i), s.rest_length, s.stiffness});
  return system;
}

ClothSystem irregular_triangulation(int rows, int columns, double stiffness, bool pins, Random& random) {
  const double cell = 1.0 / std::max(rows, columns);  // m
  Vec3Field start(static_cast<std::size_t>(rows * columns));
  std::vector<int> pinned;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto shift = [&] { return cell * random.uniform(-0.3, 0.3); };
      start.set(static_cast<std::size_t>(r * columns + c),
                {c * cell + shift(), -r * cell + shift(), shift()});
      if (pins && c + 1 == columns) pinned.push_back(r * columns + c);
    }

  std::map<std::pair<int, int>, std::vector<int>> opposite;  // of each edge: the triangles' third corners
  for (const Triangle& t : triangles_of(rows, columns, random))
    for (std::size_t k = 0; k < 3; ++k) opposite[std::minmax(t[k], t[(k + 1) % 3])].push_back(t[(k + 2) % 3]);
  std::vector<MeshSpring> springs;
  const auto join = [&](int i, int j, double k, SpringFamily family) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    springs.push_back({i, j, (start[b] - start[a]).norm(), k, family});
  };
  for (const auto& [edge, corners] : opposite) {
    join(edge.first, edge.second, stiffness, SpringFamily::structural);
    if (corners.size() == 2) join(corners[0], corners[1], 0.1 * stiffness, SpringFamily::flexion);
  }
  return renumbered(mesh_system(start, springs, pinned), random_order(rows * columns, random));
}

ClothSystem shuffled_grid(int rows, int columns, Random& random) {
  Scene scene = bare_sheet(rows, columns);
  scene.springs = SpringMaterial{.structural = 80, .shear = 40, .flexion = 20, .damping = 0};
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  return renumbered(DirectRun(scene, "verlet").system, random_order(rows * columns, random));
}

std::vector<int> random_order(int size, Random& random) {
  std::vector<int> order(static_cast<std::size_t>(size));
  std::iota(order.begin(), order.end(), 0);
  for (int k = size - 1; k > 0; --k)
    std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(random.integer(0, k))]);
  return order;
}

Vec3Field renumbered(const Vec3Field& field, const ParticleOrder& order) {
  assert(field.size() == order.size());
  Vec3Field result(field.size());
  for (std::size_t k = 0; k < order.size(); ++k) result.set(k, field[at(order[k])]);
  return result;
}

ClothState renumbered(const ClothState& state, const ParticleOrder& order) {
  return {.position = renumbered(state.position, order),
          .velocity = renumbered(state.velocity, order),
          .time = state.time,
          .step = state.step};
}

ClothSystem renumbered(const ClothSystem& system, const ParticleOrder& order) {
  assert(system.mass.size() == order.size());
  ClothSystem result;
  result.rows = 1;
  result.columns = static_cast<int>(order.size());
  result.diagonal = system.diagonal;
  result.start = renumbered(system.start, order);
  for (const int old : order) {
    result.mass.push_back(system.mass[at(old)]);
    result.inverse_mass.push_back(system.inverse_mass[at(old)]);
    result.pinned.push_back(system.pinned[at(old)]);
  }
  const ParticleOrder number = inverse_of(order);
  std::vector<SpringRun> springs;
  for_each_spring(system.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    const auto [low, high] = std::minmax(number[i], number[j]);
    springs.push_back({run.family, low, 1, high - low, run.rest_length, run.stiffness});
  });
  std::stable_sort(springs.begin(), springs.end(), [](const SpringRun& a, const SpringRun& b) {
    return std::tuple(a.family, a.first, a.offset) < std::tuple(b.family, b.first, b.offset);
  });
  result.springs = springs;
  return result;
}

}  // namespace cloth::test
