#include "kernels/vector_kernels.h"

#include "kernels/four.h"
#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

void multiply_blocks(BlockRows b, ConstVectorRows d, VectorRows p, std::size_t count) {
  double* __restrict px = p.x, * __restrict py = p.y, * __restrict pz = p.z;
  for (std::size_t i = 0; i < count; ++i) {
    const double dx = d.x[i], dy = d.y[i], dz = d.z[i];
    px[i] = b.xx[i] * dx + b.xy[i] * dy + b.xz[i] * dz;
    py[i] = b.xy[i] * dx + b.yy[i] * dy + b.yz[i] * dz;
    pz[i] = b.xz[i] * dx + b.yz[i] * dy + b.zz[i] * dz;
  }
}

/// Of springs from s to s + offset; the ends of one may be those of another.
void add_to_ends(const double* g, double* to, std::ptrdiff_t offset, int count) {
  for (int s = 0; s < count; ++s) to[s] += g[s];
  to += offset;
  for (int s = 0; s < count; ++s) to[s] -= g[s];
}

void add_springs(BlockRows b, ConstVectorRows d, VectorRows p, std::ptrdiff_t offset, int count) {
  alignas(64) double gx[VectorKernels::max_springs], gy[VectorKernels::max_springs],
      gz[VectorKernels::max_springs];
  for (int s = 0; s < count; ++s) {
    const double dx = d.x[s] - d.x[s + offset], dy = d.y[s] - d.y[s + offset], dz = d.z[s] - d.z[s + offset];
    gx[s] = b.xx[s] * dx + b.xy[s] * dy + b.xz[s] * dz;
    gy[s] = b.xy[s] * dx + b.yy[s] * dy + b.yz[s] * dz;
    gz[s] = b.xz[s] * dx + b.yz[s] * dy + b.zz[s] * dz;
  }
  add_to_ends(gx, p.x, offset, count);
  add_to_ends(gy, p.y, offset, count);
  add_to_ends(gz, p.z, offset, count);
}

/// With de = (I - a a^T) dd/|d| the change of u . a is u . de, and g the opposite of the force's change.
void add_damper_turns(double damping, MovingRows m, VectorRows product, std::ptrdiff_t offset, int count) {
  constexpr int most = VectorKernels::max_springs;
  alignas(64) double gx[most], gy[most], gz[most];
  const double *x = m.position.x, *y = m.position.y, *z = m.position.z;
  const double *vx = m.velocity.x, *vy = m.velocity.y, *vz = m.velocity.z;
  const double *wx = m.direction.x, *wy = m.direction.y, *wz = m.direction.z;
  for (int s = 0; s < count; ++s) {
    const std::ptrdiff_t j = s + offset;
    const double dx = x[j] - x[s], dy = y[j] - y[s], dz = z[j] - z[s];
    const double ux = vx[j] - vx[s], uy = vy[j] - vy[s], uz = vz[j] - vz[s];
    const double ddx = wx[j] - wx[s], ddy = wy[j] - wy[s], ddz = wz[j] - wz[s];
    const double length = __builtin_sqrt(dx * dx + dy * dy + dz * dz);
    const double inverse = length > 0 ? 1 / length : 0;
    const double ax = inverse * dx, ay = inverse * dy, az = inverse * dz;
    const double ua = ux * ax + uy * ay + uz * az, along = ddx * ax + ddy * ay + ddz * az;
    const double turn = ux * ddx + uy * ddy + uz * ddz - 2 * along * ua;
    const double scale = -damping * inverse;
    gx[s] = scale * (turn * ax + ua * ddx);
    gy[s] = scale * (turn * ay + ua * ddy);
    gz[s] = scale * (turn * az + ua * ddz);
  }
  add_to_ends(gx, product.x, offset, count);
  add_to_ends(gy, product.y, offset, count);
  add_to_ends(gz, product.z, offset, count);
}

bool add_spring_slopes(SpringSlopes springs, ConstVectorRows p, BlockSums sums, int count) {
  constexpr int most = VectorKernels::max_springs;
  alignas(64) double ax[most], ay[most], az[most], across[most], along[most];
  const double k = springs.stiffness, L = springs.rest_length;
  bool is_compressed = false;
  for (int begin = 0; begin < count; begin += most) {
    const int part = count - begin < most ? count - begin : most;
    const double *x = p.x + begin, *y = p.y + begin, *z = p.z + begin;
    const double *xj = x + springs.offset, *yj = y + springs.offset, *zj = z + springs.offset;
    for (int s = 0; s < part; ++s) {
      const double dx = xj[s] - x[s], dy = yj[s] - y[s], dz = zj[s] - z[s];
      const double length = __builtin_sqrt(dx * dx + dy * dy + dz * dz);
      const double inverse = length > 0 ? 1 / length : 0;
      ax[s] = inverse * dx, ay[s] = inverse * dy, az[s] = inverse * dz;
      across[s] = length > 0 ? k * (1 - L * inverse) : k;
    }
    for (int s = 0; s < part; ++s) is_compressed |= across[s] < 0;
    if (springs.clamped)
      for (int s = 0; s < part; ++s) across[s] = across[s] < 0 ? 0 : across[s];
    for (int s = 0; s < part; ++s) along[s] = k + springs.damping - across[s];
    const auto add = [&](const double* a, const double* b, double* sum) {
      for (int s = 0; s < part; ++s) sum[begin + s] += along[s] * a[s] * b[s];
    };
    const auto add_to_diagonal = [&](const double* a, double* sum) {
      for (int s = 0; s < part; ++s) sum[begin + s] += across[s] + along[s] * a[s] * a[s];
    };
    add_to_diagonal(ax, sums.xx), add_to_diagonal(ay, sums.yy), add_to_diagonal(az, sums.zz);
    add(ax, ay, sums.xy), add(ax, az, sums.xz), add(ay, az, sums.yz);
  }
  return is_compressed;
}

void add_multiple(double scale, const double* __restrict from, double* __restrict to, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) to[k] += scale * from[k];
}

void scale_and_add(double scale, const double* __restrict from, double* __restrict to, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) to[k] = scale * to[k] + from[k];
}

double squared_stretches(ConstVectorRows at, std::ptrdiff_t offset, double rest_length, std::size_t count) {
  const double *jx = at.x + offset, *jy = at.y + offset, *jz = at.z + offset;
  double sum[8] = {};
  kernels::in_parts<8>(count, [&](std::size_t s, int part) {
    const double dx = jx[s] - at.x[s], dy = jy[s] - at.y[s], dz = jz[s] - at.z[s];
    const double stretch = __builtin_sqrt(dx * dx + dy * dy + dz * dz) - rest_length;
    sum[part] += stretch * stretch;
  });
  return kernels::pairwise_sum(sum);
}

double dot(const double* a, const double* b, std::size_t count) {
  return kernels::dot_product(a, b, count);
}

using kernels::Four, kernels::load_four, kernels::store_four;

void to_vectors(ConstVectorRows field, double* vectors, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    store_four(vectors + 4 * i, Four{field.x[i], field.y[i], field.z[i], 0});
}

void add_vectors(const double* vectors, VectorRows field, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Four v = load_four(vectors + 4 * i);
    field.x[i] += v[0], field.y[i] += v[1], field.z[i] += v[2];
  }
}

/// Two sums side by side, so that an addition need not wait for the one before.
void multiply_rows(DifferenceRows rows, double scale, const double* direction, double* product) {
  for (std::size_t i = 0; i < rows.count; ++i) {
    const Four here = load_four(direction + 4 * i);
    Four even{}, odd{};
    const std::uint32_t end = rows.begin[i + 1];
    std::uint32_t e = rows.begin[i];
    for (; e + 2 <= end; e += 2) {
      even += rows.number[e] * (load_four(direction + 4 * rows.column[e]) - here);
      odd += rows.number[e + 1] * (load_four(direction + 4 * rows.column[e + 1]) - here);
    }
    if (e < end) even += rows.number[e] * (load_four(direction + 4 * rows.column[e]) - here);
    store_four(product + 4 * i, scale * (even + odd));
  }
}

void add_triangles(TriangleRows triangles, double scale, const double* position, const double* direction,
                   double* product) {
  const double four_times = 4 * scale;
  for (std::size_t t = 0; t < triangles.count; ++t) {
    const int* corner = triangles.corner + t * triangles.corner_stride;
    const double* k = triangles.k + t * triangles.k_stride;
    Four edge[3];
    double rate[3];
    for (int e = 0; e < 3; ++e) {
      const int from = 4 * corner[e], to = 4 * corner[(e + 1) % 3];
      edge[e] = load_four(position + to) - load_four(position + from);
      rate[e] =
          four_times * kernels::product(edge[e], load_four(direction + to) - load_four(direction + from));
    }
    for (int e = 0; e < 3; ++e)
      edge[e] = (k[3 * e] * rate[0] + k[3 * e + 1] * rate[1] + k[3 * e + 2] * rate[2]) * edge[e];
    for (int c = 0; c < 3; ++c) {
      double* to = product + 4 * corner[c];
      store_four(to, load_four(to) + (edge[(c + 2) % 3] - edge[c]));
    }
  }
}

constexpr VectorKernels table{
    multiply_blocks, add_springs,   add_spring_slopes, add_damper_turns, to_vectors,   add_vectors,
    multiply_rows,   add_triangles, squared_stretches, dot,              add_multiple, scale_and_add};

}  // namespace

const VectorKernels& VectorKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
