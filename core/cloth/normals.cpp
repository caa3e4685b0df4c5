#include "cloth/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cloth {
namespace {

void normalise(double* nx, double* ny, double* nz, int count) {
  for (int i = 0; i < count; ++i) {
    const double length = std::sqrt(nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]);
    const double scale = length > 0 ? 1 / length : 0;
    nx[i] *= scale, ny[i] *= scale, nz[i] *= scale;
  }
}

/// From the sum of cross products and its change to the change of the normal.
void normalise_changes(const double* sx, const double* sy, const double* sz, int count, double* dx,
                       double* dy, double* dz) {
#pragma GCC ivdep  // sums and changes do not alias
  for (int i = 0; i < count; ++i) {
    const double square = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
    const double along = sx[i] * dx[i] + sy[i] * dy[i] + sz[i] * dz[i];
    const double scale = square > 0 ? 1 / std::sqrt(square) : 0, part = square > 0 ? along / square : 0;
    dx[i] = scale * (dx[i] - part * sx[i]);
    dy[i] = scale * (dy[i] - part * sy[i]);
    dz[i] = scale * (dz[i] - part * sz[i]);
  }
}

/// Columns of a grid that are processed at a time, so that their cross products stay in the first cache.
constexpr int strip_width = 128;

/// Columns [first, last) of a grid, and its cells beside them: those with left edges in [begin, end).
struct Strip {
  int rows, columns, first, last;

  int begin() const { return std::max(0, first - 1); }
  int end() const { return std::min(last, columns - 1); }
  int count() const { return last - first; }
};

/// The vectors of one row of cells: [k] is that of the cell whose left edge is column first - 1 + k, 0 where
/// there is none. A cell's corners are a b above and d c below; its two triangles share a c.
struct CellRow {
  static constexpr int most = strip_width + 1;
  std::array<double, most> lower_x, lower_y, lower_z;  ///< (d - a) x (c - a), or its change
  std::array<double, most> upper_x, upper_y, upper_z;  ///< (c - a) x (b - a), or its change

  void clear() {
    for (auto* of : {&lower_x, &lower_y, &lower_z, &upper_x, &upper_y, &upper_z}) of->fill(0);
  }

  /// Cross products of the cells below `row`.
  void compute(const Strip& strip, int row, const Vec3Field& position) {
    const int at = row * strip.columns + strip.begin(), to = strip.begin() - (strip.first - 1);
    const double *xa = position.x() + at, *ya = position.y() + at, *za = position.z() + at;
    const double *xd = xa + strip.columns, *yd = ya + strip.columns, *zd = za + strip.columns;
    double *lx = lower_x.data() + to, *ly = lower_y.data() + to, *lz = lower_z.data() + to;
    double *ux = upper_x.data() + to, *uy = upper_y.data() + to, *uz = upper_z.data() + to;
    const int cells = strip.end() - strip.begin();
#pragma GCC ivdep  // cells and positions do not alias
    for (int k = 0; k < cells; ++k) {
      const double cx = xd[k + 1] - xa[k], cy = yd[k + 1] - ya[k], cz = zd[k + 1] - za[k];  // c - a
      const double dx = xd[k] - xa[k], dy = yd[k] - ya[k], dz = zd[k] - za[k];
      const double bx = xa[k + 1] - xa[k], by = ya[k + 1] - ya[k], bz = za[k + 1] - za[k];
      lx[k] = dy * cz - dz * cy, ly[k] = dz * cx - dx * cz, lz[k] = dx * cy - dy * cx;
      ux[k] = cy * bz - cz * by, uy[k] = cz * bx - cx * bz, uz[k] = cx * by - cy * bx;
    }
  }

  /// Their changes where the positions move along `direction`: one factor's change, then the other's.
  void compute_changes(const Strip& strip, int row, const Vec3Field& position, const Vec3Field& direction) {
    const int at = row * strip.columns + strip.begin(), to = strip.begin() - (strip.first - 1);
    const double* x[3] = {position.x() + at, position.y() + at, position.z() + at};
    const double* v[3] = {direction.x() + at, direction.y() + at, direction.z() + at};
    double* lower[3] = {lower_x.data() + to, lower_y.data() + to, lower_z.data() + to};
    double* upper[3] = {upper_x.data() + to, upper_y.data() + to, upper_z.data() + to};
    const int cells = strip.end() - strip.begin(), below = strip.columns;
    for (int n = 0; n < 3; ++n) {
      const double *xp = x[(n + 1) % 3], *xq = x[(n + 2) % 3], *vp = v[(n + 1) % 3], *vq = v[(n + 2) % 3];
      double *l = lower[n], *u = upper[n];
#pragma GCC ivdep  // cells, positions and the direction do not alias
      for (int k = 0; k < cells; ++k) {
        const double cp = xp[below + k + 1] - xp[k], cq = xq[below + k + 1] - xq[k];
        const double vcp = vp[below + k + 1] - vp[k], vcq = vq[below + k + 1] - vq[k];
        const double dp = xp[below + k] - xp[k], dq = xq[below + k] - xq[k];
        const double vdp = vp[below + k] - vp[k], vdq = vq[below + k] - vq[k];
        const double bp = xp[k + 1] - xp[k], bq = xq[k + 1] - xq[k];
        const double vbp = vp[k + 1] - vp[k], vbq = vq[k + 1] - vq[k];
        l[k] = (vdp * cq - vdq * cp) + (dp * vcq - dq * vcp);
        u[k] = (vcp * bq - vcq * bp) + (cp * vbq - cq * vbp);
      }
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

/// The rows of cells above and below a row of particles.
class CellRows {
 public:
  CellRows() {
    for (CellRow& of_row : cells_) of_row.clear();
  }

  /// To the next row of particles: compute(row of cells) for those below it, where there are any.
  template <class Compute>
  void advance(bool has_below, Compute compute) {
    std::swap(above_, below_);
    has_below ? compute(*below_) : below_->clear();
  }

  void sum(int count, double* x, double* y, double* z) const {
    const auto add = [&](const auto& lower, const auto& upper, double* to) {
      add_cells((above_->*lower).data(), (above_->*upper).data(), (below_->*lower).data(),
                (below_->*upper).data(), count, to);
    };
    add(&CellRow::lower_x, &CellRow::upper_x, x);
    add(&CellRow::lower_y, &CellRow::upper_y, y);
    add(&CellRow::lower_z, &CellRow::upper_z, z);
  }

 private:
  std::array<CellRow, 2> cells_;
  CellRow *above_ = &cells_[0], *below_ = &cells_[1];
};

/// Of rows [begin, end).
void strip_normals(const Strip& strip, int begin, int end, const Vec3Field& position, Vec3Field& normal) {
  CellRows cells;
  if (begin > 0) cells.advance(true, [&](CellRow& below) { below.compute(strip, begin - 1, position); });
  for (int row = begin; row < end; ++row) {
    cells.advance(row + 1 < strip.rows, [&](CellRow& below) { below.compute(strip, row, position); });
    const int at = row * strip.columns + strip.first;
    double *nx = normal.x() + at, *ny = normal.y() + at, *nz = normal.z() + at;
    cells.sum(strip.count(), nx, ny, nz);
    normalise(nx, ny, nz, strip.count());
  }
}

void strip_normal_changes(const Strip& strip, const Vec3Field& position, const Vec3Field& direction,
                          Vec3Field& change) {
  CellRows cells, changes;
  std::array<double, strip_width> sx, sy, sz;
  for (int row = 0; row < strip.rows; ++row) {
    const bool has_below = row + 1 < strip.rows;
    cells.advance(has_below, [&](CellRow& below) { below.compute(strip, row, position); });
    changes.advance(has_below,
                    [&](CellRow& below) { below.compute_changes(strip, row, position, direction); });
    const int at = row * strip.columns + strip.first;
    double *dx = change.x() + at, *dy = change.y() + at, *dz = change.z() + at;
    cells.sum(strip.count(), sx.data(), sy.data(), sz.data());
    changes.sum(strip.count(), dx, dy, dz);
    normalise_changes(sx.data(), sy.data(), sz.data(), strip.count(), dx, dy, dz);
  }
}

template <class Visit>
void for_each_strip(int rows, int columns, Visit visit) {
  for (int first = 0; first < columns; first += strip_width)
    visit(Strip{rows, columns, first, std::min(first + strip_width, columns)});
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

void particle_normals_of_rows(int begin, int end, int rows, int columns, const Vec3Field& position,
                              Vec3Field& normal) {
  for_each_strip(rows, columns,
                 [&](const Strip& strip) { strip_normals(strip, begin, end, position, normal); });
}

void particle_normals(int rows, int columns, const Vec3Field& position, Vec3Field& normal) {
  particle_normals_of_rows(0, rows, rows, columns, position, normal);
}

Vec3 particle_normal(int rows, int columns, const Vec3Field& position, std::size_t particle) {
  const int row = static_cast<int>(particle) / columns, column = static_cast<int>(particle) % columns;
  Vec3 sum = Vec3::Zero();
  for (const int r : {row - 1, row})
    for (const int c : {column - 1, column}) {
      if (r < 0 || r + 1 >= rows || c < 0 || c + 1 >= columns) continue;
      const auto corner =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c);
      const auto below = corner + static_cast<std::size_t>(columns);
      const Vec3 a = position[corner], diagonal = position[below + 1] - a;
      // The particle is b of the cell at its lower left and d of that at its upper right.
      if (particle != corner + 1) sum += (position[below] - a).cross(diagonal);
      if (particle != below) sum += diagonal.cross(position[corner + 1] - a);
    }
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero());
}

void particle_normal_changes(int rows, int columns, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change) {
  for_each_strip(rows, columns,
                 [&](const Strip& strip) { strip_normal_changes(strip, position, direction, change); });
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
  normalise_changes(sum.x(), sum.y(), sum.z(), static_cast<int>(sum.size()), change.x(), change.y(),
                    change.z());
}

}  // namespace cloth
