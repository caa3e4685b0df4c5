#include "sparse/block_coarsen_kernels.h"

namespace cloth {
namespace {

constexpr int reach_of_mask = CoarseLine::mask_reach;

/// Where the blocks of a coupling in either direction lie from those of a row of particles; null where there
/// are none.
CLOTHLAB_INLINE const float* source_of(const NaturalBlocks& blocks, int down, int right) {
  const bool opposite = down < 0 || (down == 0 && right < 0);
  const int number = blocks.number_of(opposite ? BlockCoupling{-down, -right} : BlockCoupling{down, right});
  if (!blocks.used[number]) return nullptr;
  const std::ptrdiff_t shift =
      opposite ? static_cast<std::ptrdiff_t>(down) * blocks.columns + right : std::ptrdiff_t{0};
  return blocks.blocks_of(number) + shift;
}

/// The matrix after its columns are halved: blocks (down >= 0, right) between rows of the fine grid and
/// columns of the coarse one; for down = 0 those with right >= 0.
struct HalvedColumns {
  int rows, columns, reach_down, reach;
  float* numbers;
  bool used[(most_reach + 1) * (2 * most_reach + 1)];

  CLOTHLAB_INLINE std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(rows) * columns; }
  CLOTHLAB_INLINE int number_of(int down, int right) const { return down * (2 * reach + 1) + right + reach; }
  CLOTHLAB_INLINE float* blocks_of(int number) const { return numbers + 6 * number * size(); }
};

/// The blocks of a coupling to add to, zero where it was not used before.
template <class Blocks>
float* sums_of(Blocks& to, int number, std::ptrdiff_t particles) {
  float* sums = to.blocks_of(number);
  if (!to.used[number])
    for (std::ptrdiff_t k = 0; k < 6 * particles; ++k) sums[k] = 0;
  to.used[number] = true;
  return sums;
}

/// One fine column 2 J + child, its coupling by `right` columns, and one of that one's parents, J + parent.
struct ColumnJob {
  int child, right, parent;
  float weight;
};

/// For the coarse columns [first, last).
CLOTHLAB_INLINE void add_columns(const ColumnJob& job, const float* from, int fine, int coarse, int first,
                                 int last, float* to) {
  const int end = job.child + job.right;
  while (first < last && (2 * first + job.child < 0 || 2 * first + end < 0 || first + job.parent < 0))
    ++first;
  while (last > first && (2 * (last - 1) + job.child >= fine || 2 * (last - 1) + end >= fine ||
                          last - 1 + job.parent >= coarse))
    --last;
  const float* source = from + job.child;
  for (int column = first; column < last; ++column) to[column] += job.weight * source[2 * column];
}

/// The coarse columns around which all weights are those of the mask.
struct Columns {
  int begin, end;
};
CLOTHLAB_INLINE Columns regular_columns(const CoarseLine& line, int reach) {
  if (line.regular_begin == line.regular_end) return {0, 0};
  const int around = reach_of_mask + reach;
  const int begin = line.regular_begin == 0 ? 0 : (line.regular_begin + around + 1) / 2;
  const int end = line.regular_end == line.fine
                      ? line.coarse
                      : (line.regular_end - 1 - around + 2) / 2;  // 2 (end - 1) + around < regular_end
  return {begin, end > begin ? end : begin};
}

/// Every number of a row of `fine`, for one coupling, in regular columns.
void halve_row(const NaturalBlocks& fine, const float* source, const CoarseLine& line, Columns regular,
               int row, int down, int right, HalvedColumns& to) {
  for (int child = -reach_of_mask; child <= reach_of_mask; ++child)
    for (int parent = down == 0 ? 0 : -to.reach; parent <= to.reach; ++parent) {
      const int from_parent = child + right - 2 * parent;
      if (from_parent < -reach_of_mask || from_parent > reach_of_mask) continue;
      const float weight = line.mask[child + reach_of_mask] * line.mask[from_parent + reach_of_mask];
      if (weight == 0) continue;
      float* sums = sums_of(to, to.number_of(down, parent), to.size()) + row * to.columns;
      for (int n = 0; n < 6; ++n)
        add_columns({child, right, parent, weight}, source + n * fine.particles() + row * fine.columns,
                    line.fine, line.coarse, regular.begin, regular.end, sums + n * to.size());
    }
}

/// The same for every row of one coarse column, by the lists of its children and their parents.
void halve_column(const NaturalBlocks& fine, const float* source, const CoarseLine& line, int column,
                  int down, int right, HalvedColumns& to) {
  const LineWeights& children = line.children[column];
  for (int child = 0; child < children.count; ++child) {
    const int from = children.first + child, end = from + right;
    if (end < 0 || end >= line.fine) continue;
    const LineWeights& parents = line.parents[end];
    for (int k = 0; k < parents.count; ++k) {
      const int parent = parents.first + k - column;
      const float weight = children.weight[child] * parents.weight[k];
      if (weight == 0 || (down == 0 && parent < 0)) continue;
      float* sums = sums_of(to, to.number_of(down, parent), to.size()) + column;
      for (int n = 0; n < 6; ++n)
        for (int row = 0; row + down < fine.rows; ++row)
          sums[n * to.size() + row * to.columns] +=
              weight * source[n * fine.particles() + row * fine.columns + from];
    }
  }
}

void halve_columns(const NaturalBlocks& fine, const CoarseLine& line, HalvedColumns& to) {
  for (bool& used : to.used) used = false;
  const Columns regular = regular_columns(line, fine.reach);
  for (int down = 0; down <= fine.reach; ++down)
    for (int right = -fine.reach; right <= fine.reach; ++right) {
      const float* source = source_of(fine, down, right);
      if (!source) continue;
      for (int row = 0; row + down < fine.rows && regular.begin < regular.end; ++row)
        halve_row(fine, source, line, regular, row, down, right, to);
      for (int column = 0; column < line.coarse; ++column)
        if (column < regular.begin || column >= regular.end)
          halve_column(fine, source, line, column, down, right, to);
    }
}

/// A fine row, the one that is `apart` below it, and coarse rows `to` and, `down` below it, one of the
/// latter's parents.
struct RowJob {
  int row, apart, to, down;
  float weight;
};

void add_rows(const HalvedColumns& from, const RowJob& job, int right, NaturalBlocks& coarse) {
  const bool opposite = job.apart < 0 || (job.apart == 0 && right < 0);
  const int number = opposite ? from.number_of(-job.apart, -right) : from.number_of(job.apart, right);
  if (!from.used[number]) return;
  const int columns = coarse.columns;
  const std::ptrdiff_t first_row = opposite ? job.row + job.apart : job.row;
  const float* source = from.blocks_of(number) + first_row * columns + (opposite ? right : 0);
  float* sums = sums_of(coarse, coarse.number_of({job.down, right}), coarse.particles()) +
                static_cast<std::ptrdiff_t>(job.to) * columns;
  const int first = right < 0 ? -right : 0, last = right > 0 ? columns - right : columns;
  for (int n = 0; n < 6; ++n) {
    const float* numbers = source + n * from.size();
    float* __restrict target = sums + n * coarse.particles();
    for (int column = first; column < last; ++column) target[column] += job.weight * numbers[column];
  }
}

void halve_rows(const HalvedColumns& from, const CoarseLine& line, NaturalBlocks& coarse) {
  for (bool& used : coarse.used) used = false;
  for (int to = 0; to < line.coarse; ++to)
    for (int child = 0; child < line.children[to].count; ++child) {
      const int row = line.children[to].first + child;
      for (int apart = -from.reach_down; apart <= from.reach_down; ++apart) {
        if (row + apart < 0 || row + apart >= line.fine) continue;
        const LineWeights& parents = line.parents[row + apart];
        for (int k = 0; k < parents.count; ++k) {
          const int down = parents.first + k - to;
          const float weight = line.children[to].weight[child] * parents.weight[k];
          if (down < 0 || weight == 0) continue;
          for (int right = down == 0 ? 0 : -coarse.reach; right <= coarse.reach; ++right)
            add_rows(from, {row, apart, to, down, weight}, right, coarse);
        }
      }
    }
}

void coarsen(const NaturalBlocks& fine, const CoarseLine& rows, const CoarseLine& columns,
             NaturalBlocks& coarse, float* scratch) {
  HalvedColumns between{fine.rows, coarse.columns, fine.reach, coarse.reach, scratch, {}};
  halve_columns(fine, columns, between);
  halve_rows(between, rows, coarse);
}

constexpr BlockCoarsenKernels table{coarsen};

}  // namespace

const BlockCoarsenKernels& BlockCoarsenKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
