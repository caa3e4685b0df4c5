#include "sparse/block_cycle_kernels.h"

#include "sparse/float_registers.h"

namespace cloth {
namespace {

struct ThreeFloats {
  Floats x, y, z;
};

CLOTHLAB_INLINE ThreeFloats read_vector(const float* p, std::ptrdiff_t w) {
  return {read(p), read(p + w), read(p + 2 * w)};
}
CLOTHLAB_INLINE void write_vector(float* p, std::ptrdiff_t w, const ThreeFloats& v) {
  write(p, v.x), write(p + w, v.y), write(p + 2 * w, v.z);
}

/// sum - B v
CLOTHLAB_INLINE ThreeFloats less_product(const ThreeFloats& sum, const float* block, std::ptrdiff_t w,
                                         const ThreeFloats& v) {
  const Floats xx = read(block), xy = read(block + w), xz = read(block + 2 * w);
  const Floats yy = read(block + 3 * w), yz = read(block + 4 * w), zz = read(block + 5 * w);
  return {sum.x - (xx * v.x + xy * v.y + xz * v.z), sum.y - (xy * v.x + yy * v.y + yz * v.z),
          sum.z - (xz * v.x + yz * v.y + zz * v.z)};
}

/// begin - sum of A_ij x_j over a particle's neighbours first <= j < last.
CLOTHLAB_INLINE ThreeFloats less_neighbours(const BlockLevel& l, const BlockLevel::Colour& colour, int first,
                                            int last, const float* x, const float* blocks, ThreeFloats sum) {
  for (int k = first; k < last; ++k) {
    const BlockNeighbour& n = colour.neighbour[k];
    sum = less_product(sum, blocks + n.block, l.width, read_vector(x + n.vector, l.width));
  }
  return sum;
}

/// Visits a row's colour: visit(first number of x, b and r, of the blocks, of the inverse).
template <class Visit>
CLOTHLAB_INLINE void for_each_register(const BlockLevel& l, int row, int colour, Visit visit) {
  const int count = (l.columns - colour + 2) / 3;
  const std::ptrdiff_t vector = row * 3 * l.width + colour * l.segment;
  const std::ptrdiff_t block = row * 6 * l.couplings * l.width + colour * l.segment;
  const std::ptrdiff_t inverse = row * 6 * l.width + colour * l.segment;
  for (int t = 0; t < count; t += width) visit(vector + t, block + t, inverse + t);
}

CLOTHLAB_INLINE ThreeFloats zero_less(const ThreeFloats& v) {
  return {-v.x, -v.y, -v.z};
}

/// Solves for the particles of a row: x_i = A_ii^-1 (b_i - sum over neighbours).
template <bool forward>
CLOTHLAB_INLINE void solve_row(const BlockLevel& l, int row) {
  for (int turn = 0; turn < 3; ++turn) {
    const int c = forward ? turn : 2 - turn;
    const BlockLevel::Colour& colour = l.colour[c];
    for_each_register(l, row, c, [&](std::ptrdiff_t v, std::ptrdiff_t b, std::ptrdiff_t d) {
      const ThreeFloats left = less_neighbours(l, colour, 0, forward ? colour.earlier : colour.all, l.x + v,
                                               l.blocks + b, read_vector(l.b + v, l.width));
      const ThreeFloats none{Floats{}, Floats{}, Floats{}};
      write_vector(l.x + v, l.width, zero_less(less_product(none, l.inverse + d, l.width, left)));
    });
  }
}

/// After the forward sweep from zero only what comes later is missing: r_i = -sum over later neighbours.
CLOTHLAB_INLINE void residual_row(const BlockLevel& l, int row) {
  for (int c = 0; c < 3; ++c) {
    const BlockLevel::Colour& colour = l.colour[c];
    for_each_register(l, row, c, [&](std::ptrdiff_t v, std::ptrdiff_t b, std::ptrdiff_t) {
      const ThreeFloats none{Floats{}, Floats{}, Floats{}};
      write_vector(l.r + v, l.width,
                   less_neighbours(l, colour, colour.earlier, colour.all, l.x + v, l.blocks + b, none));
    });
  }
}

void descend(const BlockLevel& l) {
  for (int row = 0; row < l.rows + 2; ++row) {
    if (row < l.rows) solve_row<true>(l, row);
    if (row >= 2) residual_row(l, row - 2);  // its later neighbours are solved, and in the cache
  }
}

void ascend(const BlockLevel& l) {
  for (int row = l.rows - 1; row >= 0; --row) solve_row<false>(l, row);
}

// ---- Galerkin's product ----

/// Interpolation along a line: a point of the fine line and its parents on the coarse one.
struct Parents {
  int first, last;
  float weight;
};
CLOTHLAB_INLINE Parents parents_of(int point, int fine, int coarse) {
  if (fine == coarse) return {point, point, 1};
  const int first = point / 2, last = (point + 1) / 2 < coarse ? (point + 1) / 2 : coarse - 1;
  return {first, last, first == last ? 1.0f : 0.5f};
}

/// Where the blocks of the coupling (down, right) begin, and how far before a particle they are kept; null
/// where there are none.
struct Source {
  const float* numbers;
  std::ptrdiff_t shift;
};
Source source_of(const NaturalBlocks& blocks, int down, int right) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(blocks.rows) * blocks.columns;
  int coupling = 0;
  const bool opposite = down < 0 || (down == 0 && right < 0);
  if (down != 0 || right != 0) {
    const int d = opposite ? -down : down, r = opposite ? -right : right;
    coupling = d == 0 ? r : 5 * d + r;  // 1 .. 12 in the order of block_coupling
  }
  if (!blocks.used[coupling]) return {nullptr, 0};
  return {blocks.numbers + 6 * coupling * size,
          opposite ? static_cast<std::ptrdiff_t>(down) * blocks.columns + right : 0};
}

constexpr int most_right = 2, between_columns = 2 * most_right + 1;

/// between(down, right)[row][column] of number n: at ((5 down + right + 2) * 6 + n) * size.
CLOTHLAB_INLINE float* between_numbers(float* between, std::ptrdiff_t size, int down, int right) {
  return between + 6 * (between_columns * down + right + most_right) * size;
}

/// The part of one fine column 2 J + child, and its coupling by `right` columns, for the coarse columns [0,
/// columns) where that is interpolation as inside.
struct ColumnJob {
  int child, right, parent;
  float weight;
};

void add_inside(const ColumnJob& job, const float* from, int fine, int coarse, int columns, float* to) {
  const int end = job.child + job.right;
  int first = 0, last = columns;
  while (first < last && (2 * first + job.child < 0 || 2 * first + end < 0 || first + job.parent < 0))
    ++first;
  while (last > first && (2 * (last - 1) + job.child >= fine || 2 * (last - 1) + end >= fine ||
                          last - 1 + job.parent >= coarse))
    --last;
  const float* source = from + job.child;
  for (int column = first; column < last; ++column) to[column] += job.weight * source[2 * column];
}

/// Every number of a row of `fine`, for one coupling.
void halve_row(const NaturalBlocks& fine, const Source& source, int row, int down, int right, int coarse,
               int columns, float* between) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(fine.rows) * fine.columns;
  const std::ptrdiff_t coarse_size = static_cast<std::ptrdiff_t>(fine.rows) * coarse;
  for (int child = -1; child <= 1; ++child) {
    const int end = child + right, low = end >= 0 ? end / 2 : -((1 - end) / 2);
    const float weight = (child ? 0.5f : 1.0f) * (end % 2 ? 0.5f : 1.0f);
    for (int parent = low; parent <= low + (end % 2 ? 1 : 0); ++parent) {
      if (down == 0 && parent < 0) continue;
      float* to = between_numbers(between, coarse_size, down, parent);
      for (int n = 0; n < 6; ++n)
        add_inside({child, right, parent, weight},
                   source.numbers + n * size + row * fine.columns + source.shift, fine.columns, coarse,
                   columns, to + n * coarse_size + row * coarse);
    }
  }
}

/// The same, for one coarse column, by its parents: also at the last ones of an even number of columns, and
/// where no column is left out.
void halve_column(const NaturalBlocks& fine, const Source& source, int down, int right, int coarse,
                  int column, float* between) {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(fine.rows) * fine.columns;
  const std::ptrdiff_t coarse_size = static_cast<std::ptrdiff_t>(fine.rows) * coarse;
  const int reach = fine.columns == coarse ? 0 : 1, middle = (1 + reach) * column;
  for (int from = middle - reach; from <= middle + reach; ++from) {
    if (from < 0 || from >= fine.columns || from + right < 0 || from + right >= fine.columns) continue;
    const Parents own = parents_of(from, fine.columns, coarse);
    const Parents other = parents_of(from + right, fine.columns, coarse);
    for (int parent = other.first; parent <= other.last; ++parent) {
      if (down == 0 && parent < column) continue;
      float* to = between_numbers(between, coarse_size, down, parent - column) + column;
      const float weight = own.weight * other.weight;
      for (int n = 0; n < 6; ++n)
        for (int row = 0; row < fine.rows; ++row)
          to[n * coarse_size + row * coarse] +=
              weight * source.numbers[n * size + row * fine.columns + from + source.shift];
    }
  }
}

void halve_columns(const NaturalBlocks& fine, int coarse, float* between) {
  const std::ptrdiff_t coarse_size = static_cast<std::ptrdiff_t>(fine.rows) * coarse;
  for (std::ptrdiff_t k = 0; k < 6 * 3 * between_columns * coarse_size; ++k) between[k] = 0;
  int inside = 0;
  if (fine.columns != coarse) inside = fine.columns % 2 ? coarse : coarse > 2 ? coarse - 2 : 0;
  for (int down = 0; down <= 2; ++down)
    for (int right = -most_right; right <= most_right; ++right) {
      const Source source = source_of(fine, down, right);
      if (!source.numbers) continue;
      for (int row = 0; row + down < fine.rows && inside > 0; ++row)
        halve_row(fine, source, row, down, right, coarse, inside, between);
      for (int column = inside; column < coarse; ++column)
        halve_column(fine, source, down, right, coarse, column, between);
    }
}

/// coarse(down, right) += weight between(di, right) for a fine row and the one that is `di` below it.
void add_rows(const NaturalBlocks& coarse, const float* between, int fine_rows, int row, int di, int right,
              int coarse_row, int down, float weight) {
  const int columns = coarse.columns;
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(fine_rows) * columns;
  const std::ptrdiff_t coarse_size = static_cast<std::ptrdiff_t>(coarse.rows) * columns;
  const bool opposite = di < 0 || (di == 0 && right < 0);
  const float* from =
      between +
      6 * (between_columns * (opposite ? -di : di) + (opposite ? -right : right) + most_right) * size +
      (opposite ? (row + di) * columns + right : row * columns);
  const int coupling = down == 0 ? right : 5 * down + right;
  float* to = coarse.numbers + 6 * coupling * coarse_size + coarse_row * columns;
  const int first = right < 0 ? -right : 0, last = right > 0 ? columns - right : columns;
  for (int n = 0; n < 6; ++n) {
    const float* source = from + n * size;
    float* __restrict target = to + n * coarse_size;
    for (int column = first; column < last; ++column) target[column] += weight * source[column];
  }
}

void halve_rows(const NaturalBlocks& coarse, int fine_rows, const float* between) {
  const std::ptrdiff_t numbers =
      static_cast<std::ptrdiff_t>(6 * (1 + block_couplings)) * coarse.rows * coarse.columns;
  for (std::ptrdiff_t k = 0; k < numbers; ++k) coarse.numbers[k] = 0;
  const int reach = fine_rows == coarse.rows ? 0 : 1;
  for (int to = 0; to < coarse.rows; ++to)
    for (int row = (1 + reach) * to - reach; row <= (1 + reach) * to + reach; ++row) {
      if (row < 0 || row >= fine_rows) continue;
      const Parents own = parents_of(row, fine_rows, coarse.rows);
      for (int di = -2; di <= 2; ++di) {
        if (row + di < 0 || row + di >= fine_rows) continue;
        const Parents other = parents_of(row + di, fine_rows, coarse.rows);
        for (int parent = other.first; parent <= other.last; ++parent)
          for (int right = -most_right; right <= most_right; ++right)
            if (parent > to || (parent == to && right >= 0))
              add_rows(coarse, between, fine_rows, row, di, right, to, parent - to,
                       own.weight * other.weight);
      }
    }
}

void coarsen(const NaturalBlocks& fine, const NaturalBlocks& coarse, float* between) {
  halve_columns(fine, coarse.columns, between);
  halve_rows(coarse, fine.rows, between);
}

constexpr BlockCycleKernels table{descend, ascend, coarsen};

}  // namespace

const BlockCycleKernels& BlockCycleKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
