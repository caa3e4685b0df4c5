#include "cloth/normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cloth {
namespace {

void normalise(double* nx, double* ny, double* nz, int count) {
  for (int i = 0; i < count; ++i) {
    const double length = std::sqrt(nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]);
    const double scale = length > 0 ? 1 / length : 0;
    nx[i] *= scale, ny[i] *= scale, nz[i] *= scale;
  }
}

/// Columns of a grid that are processed at a time, so that their cross products stay in the first cache.
constexpr int strip_width = 128;

/// The cross products of one row of cells: [k] is that of the cell whose left edge is column first - 1 + k, 0
/// where there is none. A cell's corners are a b above and d c below; its two triangles share a c.
struct CellRow {
  static constexpr int most = strip_width + 1;
  std::array<double, most> lower_x, lower_y, lower_z;  ///< (d - a) x (c - a)
  std::array<double, most> upper_x, upper_y, upper_z;  ///< (c - a) x (b - a)

  void clear() {
    for (auto* of : {&lower_x, &lower_y, &lower_z, &upper_x, &upper_y, &upper_z}) of->fill(0);
  }

  /// Of the cells below `row` with left edges in the columns [begin, end).
  void compute(int columns, int row, int first, int begin, int end, const Vec3Field& position) {
    const int at = row * columns + begin, to = begin - (first - 1);
    const double *xa = position.x() + at, *ya = position.y() + at, *za = position.z() + at;
    const double *xd = xa + columns, *yd = ya + columns, *zd = za + columns;
    double *lx = lower_x.data() + to, *ly = lower_y.data() + to, *lz = lower_z.data() + to;
    double *ux = upper_x.data() + to, *uy = upper_y.data() + to, *uz = upper_z.data() + to;
#pragma GCC ivdep  // cells and positions do not alias
    for (int k = 0; k < end - begin; ++k) {
      const double cx = xd[k + 1] - xa[k], cy = yd[k + 1] - ya[k], cz = zd[k + 1] - za[k];  // c - a
      const double dx = xd[k] - xa[k], dy = yd[k] - ya[k], dz = zd[k] - za[k];
      const double bx = xa[k + 1] - xa[k], by = ya[k + 1] - ya[k], bz = za[k + 1] - za[k];
      lx[k] = dy * cz - dz * cy, ly[k] = dz * cx - dx * cz, lz[k] = dx * cy - dy * cx;
      ux[k] = cy * bz - cz * by, uy[k] = cz * bx - cx * bz, uz[k] = cx * by - cy * bx;
    }
  }
};

/// One component of a row's sums: of a particle's cells above it and below it, left and right.
void add_cells(const double* lower_above, const double* upper_above, const double* lower_below,
               const double* upper_below, int count, double* sum) {
  for (int k = 0; k < count; ++k)
    sum[k] = lower_above[k] + upper_above[k] + lower_above[k + 1] + upper_below[k] +
             (lower_below[k + 1] + upper_below[k + 1]);
}

/// The normals of the columns [first, last).
void strip_normals(int rows, int columns, int first, int last, const Vec3Field& position, Vec3Field& normal) {
  const int begin = std::max(0, first - 1), end = std::min(last, columns - 1);  // left edges of its cells
  std::array<CellRow, 2> cells;
  for (CellRow& of_row : cells) of_row.clear();
  for (int row = 0; row < rows; ++row) {
    const CellRow& above = cells[static_cast<std::size_t>((row + 1) % 2)];
    CellRow& below = cells[static_cast<std::size_t>(row % 2)];
    if (row + 1 < rows)
      below.compute(columns, row, first, begin, end, position);
    else
      below.clear();
    const int count = last - first, at = row * columns + first;
    double *nx = normal.x() + at, *ny = normal.y() + at, *nz = normal.z() + at;
    const auto add = [&](const auto& lower, const auto& upper, double* sum) {
      add_cells((above.*lower).data(), (above.*upper).data(), (below.*lower).data(), (below.*upper).data(),
                count, sum);
    };
    add(&CellRow::lower_x, &CellRow::upper_x, nx);
    add(&CellRow::lower_y, &CellRow::upper_y, ny);
    add(&CellRow::lower_z, &CellRow::upper_z, nz);
    normalise(nx, ny, nz, count);
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
  for (int first = 0; first < columns; first += strip_width)
    strip_normals(rows, columns, first, std::min(first + strip_width, columns), position, normal);
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
  normalise(normal.x(), normal.y(), normal.z(), static_cast<int>(normal.size()));
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
