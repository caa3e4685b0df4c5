#include "sparse/aggregation_kernels.h"

// Functions that take or return registers are inlined: how they would be passed between calls is no question.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace cloth {
namespace {

typedef float Four __attribute__((vector_size(16)));
typedef float Eight __attribute__((vector_size(32)));

template <int size>
struct VectorOf {
  typedef Eight Type;
  static constexpr int width = 8;
};
template <>
struct VectorOf<3> {
  typedef Four Type;
  static constexpr int width = 4;
};
template <int size>
using Vector = typename VectorOf<size>::Type;
template <int size>
constexpr int width_of = VectorOf<size>::width;

constexpr int modes = AggregationKernels::modes, row_width = AggregationKernels::row_width;

template <class V>
CLOTHLAB_INLINE V read(const float* p) {
  V value;
  __builtin_memcpy(&value, p, sizeof(V));
  return value;
}
template <class V>
CLOTHLAB_INLINE void write(float* p, V value) {
  __builtin_memcpy(p, &value, sizeof(V));
}

CLOTHLAB_INLINE void clear(float* from, const float* end) {
  for (; from != end; ++from) *from = 0;
}

template <int size>
CLOTHLAB_INLINE const float* block_of(const float* blocks, int entry) {
  return blocks + static_cast<long>(entry) * (size * size);
}
/// Of the blocks that lead to the next coarser level.
template <int size>
CLOTHLAB_INLINE long wide(int entry) {
  return static_cast<long>(entry) * (size * row_width);
}
template <int size>
CLOTHLAB_INLINE long vector(int point) {
  return static_cast<long>(point) * width_of<size>;
}

/// B v
template <int size>
CLOTHLAB_INLINE Vector<size> product(const float* block, const float* v) {
  Vector<size> sum = read<Vector<size>>(block) * v[0];
  for (int c = 1; c < size; ++c) sum += read<Vector<size>>(block + c * size) * v[c];
  return sum;
}

/// sum - sum of A_ij x_j over the entries first to last of a row, in the order in which a sweep goes. What it
/// comes to soon is fetched before: a processor does not foresee it where rows end.
template <int size, bool forward>
CLOTHLAB_INLINE Vector<size> less_products(const AggregationLevel& l, int first, int last, Vector<size> sum) {
  constexpr long ahead = forward ? 512 : -512;  // floats
  for (int n = first; n < last; ++n) {
    const int k = forward ? n : first + last - 1 - n;
    const float* block = block_of<size>(l.blocks, k);
    __builtin_prefetch(block + ahead);
    if (size == modes) __builtin_prefetch(block + ahead + 16), __builtin_prefetch(block + ahead + 32);
    sum -= product<size>(block, l.x + vector<size>(l.index.column[k]));
  }
  return sum;
}

/// x_i = A_ii^-1 left
template <int size>
CLOTHLAB_INLINE void solve_point(const AggregationLevel& l, int i, Vector<size> left) {
  float numbers[width_of<size>];
  write(numbers, left);
  write(l.x + vector<size>(i), product<size>(block_of<size>(l.inverse, i), numbers));
}

/// A row's residual is taken as soon as the rows that it reaches are solved: its blocks lie in the cache
/// still.
template <int size>
void descend(const AggregationLevel& level) {
  const AggregationLevel l = level;
  for (int row = 0; row < l.index.rows + l.reach; ++row) {
    if (row < l.index.rows)
      solve_point<size>(l, row,
                        less_products<size, true>(l, l.index.begin[row], l.diagonal[row],
                                                  read<Vector<size>>(l.b + vector<size>(row))));
    const int i = row - l.reach;
    if (i >= 0)  // after a sweep from zero only what comes later is missing
      write(l.r + vector<size>(i),
            less_products<size, true>(l, l.diagonal[i] + 1, l.index.begin[i + 1], Vector<size>{}));
  }
}

template <int size>
void ascend(const AggregationLevel& level) {
  const AggregationLevel l = level;
  for (int i = l.index.rows - 1; i >= 0; --i) {
    const Vector<size> left = less_products<size, false>(l, l.diagonal[i] + 1, l.index.begin[i + 1],
                                                         read<Vector<size>>(l.b + vector<size>(i)));
    solve_point<size>(l, i, less_products<size, false>(l, l.index.begin[i], l.diagonal[i], left));
  }
}

template <int size>
void restrict_residual(const AggregationLevel& level, const AggregationTransfer& transfer, float* coarse) {
  const AggregationLevel l = level;
  const AggregationTransfer t = transfer;
  clear(coarse, coarse + vector<modes>(t.coarse.rows));
  for (int i = 0; i < l.index.rows; ++i) {
    const float* r = l.r + vector<size>(i);
    for (int e = t.prolongator.begin[i]; e < t.prolongator.begin[i + 1]; ++e) {
      const float* p = t.p + wide<size>(e);
      Eight sum = read<Eight>(p) * r[0];
      for (int c = 1; c < size; ++c) sum += read<Eight>(p + c * row_width) * r[c];
      float* to = coarse + vector<modes>(t.prolongator.column[e]);
      write(to, read<Eight>(to) + sum);
    }
  }
}

template <int size>
void add_correction(const AggregationLevel& level, const AggregationTransfer& transfer, const float* coarse) {
  const AggregationLevel l = level;
  const AggregationTransfer t = transfer;
  for (int i = 0; i < l.index.rows; ++i) {
    Eight sums[size] = {};
    for (int e = t.prolongator.begin[i]; e < t.prolongator.begin[i + 1]; ++e) {
      const Eight of = read<Eight>(coarse + vector<modes>(t.prolongator.column[e]));
      for (int r = 0; r < size; ++r) sums[r] += read<Eight>(t.p + wide<size>(e) + r * row_width) * of;
    }
    float* x = l.x + vector<size>(i);
    for (int r = 0; r < size; ++r) {
      float sum = 0;
      for (int c = 0; c < modes; ++c) sum += sums[r][c];
      x[r] += sum;
    }
  }
}

CLOTHLAB_INLINE void set_places(const RowIndex& index, int row, int* place) {
  for (int e = index.begin[row]; e < index.begin[row + 1]; ++e) place[index.column[e]] = e;
}

/// to += B times rows of 6 columns.
template <int size>
CLOTHLAB_INLINE void add_product(const float* block, const float* rows, float* to, float scale) {
  for (int r = 0; r < size; ++r) {
    Eight sum = read<Eight>(to + r * row_width);
    for (int c = 0; c < size; ++c) sum += read<Eight>(rows + c * row_width) * (scale * block[c * size + r]);
    write(to + r * row_width, sum);
  }
}

/// The entry of row i that leads to aggregate a; -1 where there is none.
CLOTHLAB_INLINE int find_place(const RowIndex& index, int i, int a, const int* place) {
  const int e = place[a];
  return e >= index.begin[i] && e < index.begin[i + 1] && index.column[e] == a ? e : -1;
}

template <int size>
void smooth(const AggregationLevel& level, const AggregationTransfer& transfer, float weight) {
  const AggregationLevel l = level;
  const AggregationTransfer t = transfer;
  constexpr int block = size * row_width;
  for (int i = 0; i < l.index.rows; ++i) {
    const int first = t.prolongator.begin[i], end = t.prolongator.begin[i + 1], own = t.aggregate[i];
    set_places(t.prolongator, i, t.place);
    clear(t.row, t.row + wide<size>(end - first));
    for (int e = l.index.begin[i]; e < l.index.begin[i + 1]; ++e) {
      const int j = l.index.column[e], a = t.aggregate[j];
      if (a < 0) continue;
      const int there = find_place(t.prolongator, i, a, t.place);
      if (there < 0 && own < 0) continue;
      const long basis = static_cast<long>(there < 0 ? i : j) * block;  // i: j is taken to move with it
      add_product<size>(block_of<size>(l.blocks, e), t.basis + basis,
                        t.row + wide<size>((there < 0 ? t.place[own] : there) - first), 1);
    }
    for (int e = first; e < end; ++e) {
      float* p = t.p + wide<size>(e);
      const float* basis = t.basis + static_cast<long>(i) * block;
      for (int n = 0; n < block; ++n) p[n] = t.prolongator.column[e] == own ? basis[n] : 0;
      add_product<size>(block_of<size>(l.inverse, i), t.row + wide<size>(e - first), p, -weight);
    }
  }
}

/// Row i of A P.
template <int size>
CLOTHLAB_INLINE void multiply(const AggregationLevel& l, const AggregationTransfer& t, int i) {
  const int first = t.image.begin[i];
  set_places(t.image, i, t.place);
  clear(t.row, t.row + wide<size>(t.image.begin[i + 1] - first));
  for (int e = l.index.begin[i]; e < l.index.begin[i + 1]; ++e) {
    const int j = l.index.column[e];
    for (int n = t.prolongator.begin[j]; n < t.prolongator.begin[j + 1]; ++n)
      add_product<size>(block_of<size>(l.blocks, e), t.p + wide<size>(n),
                        t.row + wide<size>(t.place[t.prolongator.column[n]] - first), 1);
  }
}

/// sums += P_ik^T (A P)_il, row by row.
template <int size>
CLOTHLAB_INLINE void add_coarse_product(const float* p, const float* ap, float* sums) {
  Eight rows[size];
  for (int r = 0; r < size; ++r) rows[r] = read<Eight>(ap + r * row_width);
  for (int m = 0; m < modes; ++m) {
    Eight sum = read<Eight>(sums + m * row_width);
    for (int r = 0; r < size; ++r) sum += rows[r] * p[r * row_width + m];
    write(sums + m * row_width, sum);
  }
}

/// From sums row by row to blocks, each in its mirrored place as well.
CLOTHLAB_INLINE void arrange(const AggregationTransfer& t) {
  constexpr int square = modes * modes;
  for (int k = 0; k < t.coarse.rows; ++k)
    for (int e = t.coarse_diagonal[k]; e < t.coarse.begin[k + 1]; ++e) {
      const float* sums = t.sums + static_cast<long>(e) * AggregationKernels::sum_width;
      float* block = t.coarse_blocks + static_cast<long>(e) * square;
      float* mirrored = t.coarse_blocks + static_cast<long>(t.mirrored[e]) * square;
      for (int r = 0; r < modes; ++r)
        for (int c = 0; c < modes; ++c)
          block[c * modes + r] = mirrored[r * modes + c] = sums[r * row_width + c];
    }
}

/// P^T A P, which is symmetric: of each row the blocks from the diagonal on.
template <int size>
void coarsen(const AggregationLevel& level, const AggregationTransfer& transfer) {
  const AggregationLevel l = level;
  const AggregationTransfer t = transfer;
  clear(t.sums, t.sums + static_cast<long>(t.coarse.begin[t.coarse.rows]) * AggregationKernels::sum_width);
  for (int i = 0; i < l.index.rows; ++i) {
    multiply<size>(l, t, i);
    for (int n = t.prolongator.begin[i]; n < t.prolongator.begin[i + 1]; ++n) {
      const int k = t.prolongator.column[n];
      int entry = t.coarse_diagonal[k];
      for (int e = t.image.begin[i]; e < t.image.begin[i + 1]; ++e) {
        if (t.image.column[e] < k) continue;
        while (t.coarse.column[entry] != t.image.column[e]) ++entry;
        add_coarse_product<size>(t.p + wide<size>(n), t.row + wide<size>(e - t.image.begin[i]),
                                 t.sums + static_cast<long>(entry) * AggregationKernels::sum_width);
      }
    }
  }
  arrange(t);
}

template <int size>
constexpr AggregationKernels::Loops loops{descend<size>,        ascend<size>, restrict_residual<size>,
                                          add_correction<size>, smooth<size>, coarsen<size>};
constexpr AggregationKernels table{loops<3>, loops<6>};

}  // namespace

const AggregationKernels& AggregationKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
