#include "cloth/normals.h"

#include <array>
#include <cmath>

namespace cloth {
namespace {

struct Triple {
  double x, y, z;
};

Triple between(const double* x, const double* y, const double* z, int from, int to) {
  return {x[to] - x[from], y[to] - y[from], z[to] - z[from]};
}

Triple cross(const Triple& u, const Triple& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

void normalise(Vec3Field& normal) {
  double *nx = normal.x(), *ny = normal.y(), *nz = normal.z();
  for (std::size_t i = 0; i < normal.size(); ++i) {
    const double length = std::sqrt(nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]);
    const double scale = length > 0 ? 1 / length : 0;
    nx[i] *= scale, ny[i] *= scale, nz[i] *= scale;
  }
}

/// From the sums of cross products and their changes to the changes of normals.
void normalise_changes(const Vec3Field& sum, Vec3Field& change) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double length = sum[i].norm();
    const Vec3 n = length > 0 ? Vec3(sum[i] / length) : Vec3(0, 0, 0);
    change.set(i, length > 0 ? Vec3((change[i] - n.dot(change[i]) * n) / length) : Vec3(0, 0, 0));
  }
}

/// A triangle's two sides from its first corner.
std::array<Vec3, 2> sides_of(const Triangle& t, const Vec3Field& of) {
  const Vec3 first = of[static_cast<std::size_t>(t[0])];
  return {of[static_cast<std::size_t>(t[1])] - first, of[static_cast<std::size_t>(t[2])] - first};
}

void add_to_corners(const Triangle& t, const Vec3& vector, Vec3Field& to) {
  for (const int corner : t) to.add(static_cast<std::size_t>(corner), vector);
}

}  // namespace

void particle_normals(int rows, int columns, const Vec3Field& position, Vec3Field& normal) {
  const double *x = position.x(), *y = position.y(), *z = position.z();
  double *nx = normal.x(), *ny = normal.y(), *nz = normal.z();
  normal.fill(0);
  const auto add = [&](int i, const Triple& n) { nx[i] += n.x, ny[i] += n.y, nz[i] += n.z; };

  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column, b = a + 1, d = a + columns, c = d + 1;
      const Triple to_c = between(x, y, z, a, c);
      const Triple lower = cross(between(x, y, z, a, d), to_c);
      const Triple upper = cross(to_c, between(x, y, z, a, b));
      const Triple both{lower.x + upper.x, lower.y + upper.y, lower.z + upper.z};
      add(a, both), add(b, upper), add(c, both), add(d, lower);
    }
  }
  normalise(normal);
}

void particle_normal_changes(int rows, int columns, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change) {
  Vec3Field sum(position.size());  // of the cross products, before they are normalised
  change.fill(0);
  const auto add = [&](int i, const Vec3& n, const Vec3& dn) {
    sum.add(static_cast<std::size_t>(i), n);
    change.add(static_cast<std::size_t>(i), dn);
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column, b = a + 1, d = a + columns, c = d + 1;
      const auto side = [&](const Vec3Field& of, int to) -> Vec3 {
        return of[static_cast<std::size_t>(to)] - of[static_cast<std::size_t>(a)];
      };
      const Vec3 to_b = side(position, b), to_c = side(position, c), to_d = side(position, d);
      const Vec3 db = side(direction, b), dc = side(direction, c), dd = side(direction, d);
      const Vec3 lower = to_d.cross(to_c), upper = to_c.cross(to_b);
      const Vec3 lower_change = dd.cross(to_c) + to_d.cross(dc),
                 upper_change = dc.cross(to_b) + to_c.cross(db);
      add(a, lower + upper, lower_change + upper_change);
      add(b, upper, upper_change);
      add(c, lower + upper, lower_change + upper_change);
      add(d, lower, lower_change);
    }
  }
  normalise_changes(sum, change);
}

void particle_normals(const ClothSystem& system, const Vec3Field& position, Vec3Field& normal) {
  if (!system.is_mesh()) return particle_normals(system.rows, system.columns, position, normal);
  normal.fill(0);
  for (const Triangle& t : system.triangles) {
    const auto [u, v] = sides_of(t, position);
    add_to_corners(t, u.cross(v), normal);
  }
  normalise(normal);
}

void particle_normal_changes(const ClothSystem& system, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change) {
  if (!system.is_mesh())
    return particle_normal_changes(system.rows, system.columns, position, direction, change);
  Vec3Field sum(position.size());
  change.fill(0);
  for (const Triangle& t : system.triangles) {
    const auto [u, v] = sides_of(t, position);
    const auto [du, dv] = sides_of(t, direction);
    add_to_corners(t, u.cross(v), sum);
    add_to_corners(t, du.cross(v) + u.cross(dv), change);
  }
  normalise_changes(sum, change);
}

}  // namespace cloth
