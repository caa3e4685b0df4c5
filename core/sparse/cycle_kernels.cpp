#include "sparse/cycle_kernels.h"

#include "sparse/float_registers.h"

namespace cloth {
namespace {

struct ThreeFloats {
  Floats of[3];
};

/// b - A x at a register's particles, the first of them `at`.
CLOTHLAB_INLINE ThreeFloats residual_at(const CycleMatrix& a, const CycleField& b, const CycleField& x,
                                        std::ptrdiff_t at) {
  const float *x0 = x.of[0] + at, *x1 = x.of[1] + at, *x2 = x.of[2] + at;
  const Floats d = read(a.diagonal + at);
  Floats s0 = read(b.of[0] + at) - d * read(x0);
  Floats s1 = read(b.of[1] + at) - d * read(x1);
  Floats s2 = read(b.of[2] + at) - d * read(x2);
  if (a.uniform) {
    for (int k = 0; k < a.count; ++k) {
      const std::ptrdiff_t o = a.offset[k];
      const float w = a.weight[k];
      s0 -= w * (read(x0 - o) + read(x0 + o));
      s1 -= w * (read(x1 - o) + read(x1 + o));
      s2 -= w * (read(x2 - o) + read(x2 + o));
    }
  } else {
    for (int k = 0; k < a.count; ++k) {
      const std::ptrdiff_t o = a.offset[k];
      const Floats w = read(a.weights[k] + at);
      s0 -= w * read(x0 + o);
      s1 -= w * read(x1 + o);
      s2 -= w * read(x2 + o);
    }
  }
  return {{s0, s1, s2}};
}

template <class Visit>
CLOTHLAB_INLINE void for_each_register(const CycleGrid& grid, Visit visit) {
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; c += width) visit(r * grid.stride + c);
}

void begin(const CycleGrid& grid, const float* inverse, float scale, CycleField b, CycleField out) {
  for_each_register(grid, [&](std::ptrdiff_t at) {
    const Floats w = scale * read(inverse + at);
    for (int q = 0; q < 3; ++q) write(out.of[q] + at, w * read(b.of[q] + at));
  });
}

void relax(const CycleGrid& grid, const CycleMatrix& a, const float* inverse, float scale, CycleField b,
           CycleField x, CycleField out) {
  for_each_register(grid, [&](std::ptrdiff_t at) {
    const ThreeFloats r = residual_at(a, b, x, at);
    const Floats w = scale * read(inverse + at);
    for (int q = 0; q < 3; ++q) write(out.of[q] + at, read(x.of[q] + at) + w * r.of[q]);
  });
}

void residual(const CycleGrid& grid, const CycleMatrix& a, const float* free, CycleField b, CycleField x,
              CycleField out) {
  for_each_register(grid, [&](std::ptrdiff_t at) {
    const ThreeFloats r = residual_at(a, b, x, at);
    const Floats w = read(free + at);
    for (int q = 0; q < 3; ++q) write(out.of[q] + at, w * r.of[q]);
  });
}

/// The weight of the odd point after the last coarse one, whose only parent it is, where `fine` is even.
CLOTHLAB_INLINE float last_weight(int fine) {
  return fine % 2 == 0 ? 1.0f : 0.5f;
}

/// row = P^T r along the columns of the grid, at coarse row `to`.
CLOTHLAB_INLINE void gather_rows(const CycleGrid& fine, const CycleGrid& coarse, const float* r, int to,
                                 float* row) {
  if (coarse.rows == fine.rows) {
    const float* same = r + to * fine.stride;
    for (int c = -1; c <= fine.columns; ++c) row[c] = same[c];
    return;
  }
  const float* middle = r + 2 * to * fine.stride;
  const float *above = middle - fine.stride, *below = middle + fine.stride;
  const float weight = to + 1 == coarse.rows ? last_weight(fine.rows) : 0.5f;
  for (int c = -1; c <= fine.columns; ++c) row[c] = middle[c] + 0.5f * above[c] + weight * below[c];
}

void restrict_to(const CycleGrid& fine, const CycleGrid& coarse, const float* free, CycleField r,
                 CycleField b, float* row) {
  for (int to = 0; to < coarse.rows; ++to)
    for (int q = 0; q < 3; ++q) {
      gather_rows(fine, coarse, r.of[q], to, row);
      float* sum = b.of[q] + to * coarse.stride;
      const float* mask = free + to * coarse.stride;
      if (coarse.columns == fine.columns) {
        for (int c = 0; c < coarse.columns; ++c) sum[c] = mask[c] * row[c];
      } else {
        for (int c = 0; c < coarse.columns; ++c)
          sum[c] = mask[c] * (row[2 * c] + 0.5f * (row[2 * c - 1] + row[2 * c + 1]));
        const int last = coarse.columns - 1;
        sum[last] = mask[last] * (row[2 * last] + 0.5f * row[2 * last - 1] +
                                  last_weight(fine.columns) * row[2 * last + 1]);
      }
    }
}

/// row = P y along the columns of the grid, at fine row `to`; one number more than a coarse row.
CLOTHLAB_INLINE void spread_rows(const CycleGrid& fine, const CycleGrid& coarse, const float* y, int to,
                                 float* row) {
  const bool same = coarse.rows == fine.rows;
  const float* from = y + (same ? to : to / 2) * coarse.stride;
  if (same || to % 2 == 0 || to / 2 + 1 == coarse.rows) {
    for (int c = 0; c <= coarse.columns; ++c) row[c] = from[c];
  } else {
    const float* next = from + coarse.stride;
    for (int c = 0; c <= coarse.columns; ++c) row[c] = 0.5f * (from[c] + next[c]);
  }
}

void prolong(const CycleGrid& fine, const CycleGrid& coarse, const float* free, CycleField y, CycleField x,
             float* row) {
  for (int to = 0; to < fine.rows; ++to)
    for (int q = 0; q < 3; ++q) {
      spread_rows(fine, coarse, y.of[q], to, row);
      float* sum = x.of[q] + to * fine.stride;
      const float* mask = free + to * fine.stride;
      if (coarse.columns == fine.columns) {
        for (int c = 0; c < fine.columns; ++c) sum[c] += mask[c] * row[c];
      } else {
        if (fine.columns % 2 == 0) row[coarse.columns] = row[coarse.columns - 1];
        for (int c = 0; c < coarse.columns; ++c) {
          sum[2 * c] += mask[2 * c] * row[c];
          sum[2 * c + 1] += mask[2 * c + 1] * (0.5f * (row[c] + row[c + 1]));
        }
      }
    }
}

constexpr CycleKernels table{begin, relax, residual, restrict_to, prolong};

}  // namespace

const CycleKernels& CycleKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
