#include "sparse/block_cycle_kernels.h"

// Functions that take or return registers are inlined: how they would be passed between calls is no question.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace cloth {
namespace {

constexpr int lanes = BlockLevel::lanes;
typedef float Eight __attribute__((vector_size(4 * lanes), aligned(4), may_alias));

struct ThreeFloats {
  Eight x, y, z;
};

CLOTHLAB_INLINE Eight read(const float* p) {
  return *reinterpret_cast<const Eight*>(p);
}
CLOTHLAB_INLINE void write(float* p, Eight value) {
  *reinterpret_cast<Eight*>(p) = value;
}
CLOTHLAB_INLINE ThreeFloats read_vector(const float* p) {
  return {read(p), read(p + lanes), read(p + 2 * lanes)};
}
CLOTHLAB_INLINE void write_vector(float* p, const ThreeFloats& v) {
  write(p, v.x), write(p + lanes, v.y), write(p + 2 * lanes, v.z);
}

CLOTHLAB_INLINE ThreeFloats operator+(const ThreeFloats& a, const ThreeFloats& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
CLOTHLAB_INLINE ThreeFloats operator-(const ThreeFloats& a, const ThreeFloats& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

CLOTHLAB_INLINE ThreeFloats product(const float* block, const ThreeFloats& v) {
  const Eight xx = read(block), xy = read(block + lanes), xz = read(block + 2 * lanes);
  const Eight yy = read(block + 3 * lanes), yz = read(block + 4 * lanes), zz = read(block + 5 * lanes);
  return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
}

/// Each lane's number moves to the next lane, or to the one before; the lane that is left gets 0.
CLOTHLAB_INLINE Eight to_next(Eight v) {
  return __builtin_shufflevector(v, Eight{}, 8, 0, 1, 2, 3, 4, 5, 6);
}
CLOTHLAB_INLINE Eight to_previous(Eight v) {
  return __builtin_shufflevector(v, Eight{}, 1, 2, 3, 4, 5, 6, 7, 8);
}

/// Leaves a group's vector v, which lies at `place`, in its copies: behind the row for the lane before,
/// before the row for the lane behind.
CLOTHLAB_INLINE void write_copies(const BlockLevel& l, int group, const ThreeFloats& v, float* place) {
  const std::ptrdiff_t row = l.groups * BlockLevel::vector_group;
  if (group < l.reach) write_vector(place + row, {to_previous(v.x), to_previous(v.y), to_previous(v.z)});
  if (group >= l.groups - l.reach) write_vector(place - row, {to_next(v.x), to_next(v.y), to_next(v.z)});
}

/// Adds to a group's vector at `place` what was added to its copies, and clears those.
CLOTHLAB_INLINE void gather_copies(const BlockLevel& l, int group, float* place) {
  constexpr ThreeFloats none{};
  const std::ptrdiff_t row = l.groups * BlockLevel::vector_group;
  if (group < l.reach) {
    const ThreeFloats v = read_vector(place + row);
    write_vector(place, read_vector(place) + ThreeFloats{to_next(v.x), to_next(v.y), to_next(v.z)});
    write_vector(place + row, none);
  }
  if (group >= l.groups - l.reach) {
    const ThreeFloats v = read_vector(place - row);
    write_vector(place,
                 read_vector(place) + ThreeFloats{to_previous(v.x), to_previous(v.y), to_previous(v.z)});
    write_vector(place - row, none);
  }
}

/// x_i = A_ii^-1 (b_i - sum of A_ij x_j over couplings), and A_ij x_i is taken from `rest` of each j.
template <bool forward>
CLOTHLAB_INLINE ThreeFloats solve_group(const BlockLevel::Kind& kind, const float* blocks, const float* x,
                                        const float* b, float* rest) {
  constexpr std::ptrdiff_t ahead = (forward ? 15 : -15) * BlockLevel::block;  // what was fastest with AVX2
  ThreeFloats left = read_vector(b);
  const float* coupling = blocks + BlockLevel::block;
  for (int n = 0; n < kind.couplings; ++n, coupling += BlockLevel::block) {
    __builtin_prefetch(coupling + ahead);
    __builtin_prefetch(coupling + ahead + 16);
    __builtin_prefetch(coupling + ahead + 32);
    left = left - product(coupling, read_vector(x + kind.neighbour[n]));
  }
  const ThreeFloats solved = product(blocks, left);
  coupling = blocks + BlockLevel::block;
  for (int n = 0; n < kind.couplings; ++n, coupling += BlockLevel::block) {
    float* of_neighbour = rest + kind.neighbour[n];
    write_vector(of_neighbour, read_vector(of_neighbour) - product(coupling, solved));
  }
  return solved;
}

void descend(const BlockLevel& l) {
  constexpr ThreeFloats none{};
  for (int row = 0; row < l.rows; ++row)
    for (int group = 0; group < l.groups; ++group) {
      const std::ptrdiff_t v = row * l.vector_row + group * BlockLevel::vector_group;
      const float* blocks = l.blocks + row * l.block_row + l.place_of_blocks(group);
      const ThreeFloats solved =
          solve_group<true>(l.kind[l.kind_of(group)], blocks, l.x + v, l.b + v, l.r + v);
      write_vector(l.x + v, solved);
      write_copies(l, group, solved, l.x + v);
      write_vector(l.r + v, none);  // what comes later is missing, and takes its part from it
    }
  for (int row = 0; row < l.rows; ++row)
    for (int group = 0; group < l.groups; ++group)
      gather_copies(l, group, l.r + row * l.vector_row + group * BlockLevel::vector_group);
}

void ascend(const BlockLevel& l) {
  for (int row = l.rows - 1; row >= 0; --row)
    for (int group = l.groups - 1; group >= 0; --group) {
      const std::ptrdiff_t v = row * l.vector_row + group * BlockLevel::vector_group;
      const float* blocks = l.blocks + row * l.block_row + l.place_of_blocks(group);
      gather_copies(l, group, l.b + v);
      write_vector(l.x + v, solve_group<false>(l.kind[l.kind_of(group)], blocks, l.x + v, l.b + v, l.b + v));
    }
}

/// sums = the weighted sum of rows of vectors, which lie `stride` apart.
CLOTHLAB_INLINE void add_rows(const LineWeights& weights, const float* rows, std::ptrdiff_t stride,
                              std::ptrdiff_t count, float* sums) {
  const float* first = rows + weights.first * stride;
  for (std::ptrdiff_t i = 0; i < count; i += lanes) {
    Eight sum = weights.weight[0] * read(first + i);
    for (int k = 1; k < weights.count; ++k) sum += weights.weight[k] * read(first + k * stride + i);
    write(sums + i, sum);
  }
}

/// Numbers of lanes that have no particle.
CLOTHLAB_INLINE void clear_unused(const BlockLevel& l, float* row) {
  for (int i = l.columns; i < lanes * l.groups; ++i) row[i] = 0;
}

/// The weighted sum of single numbers.
CLOTHLAB_INLINE float weighted(const LineWeights& weights, const float* numbers) {
  float sum = 0;
  for (int k = 0; k < weights.count; ++k) sum += weights.weight[k] * numbers[weights.first + k];
  return sum;
}

/// fine = P coarse along a line. One number before and behind the coarse ones is read, and counts nothing.
CLOTHLAB_INLINE void interpolate(const CoarseLine& line, const float* coarse, float* fine) {
  const float* mask = line.mask;
  const int begin = (line.regular_begin + 1) / 2, end = line.regular_end / 2;
  for (int p = 0; p < 2 * begin; ++p) fine[p] = weighted(line.parents[p], coarse);
  for (int i = begin; i < end; ++i) {
    fine[2 * i] = mask[4] * coarse[i - 1] + mask[2] * coarse[i] + mask[0] * coarse[i + 1];
    fine[2 * i + 1] = mask[3] * coarse[i] + mask[1] * coarse[i + 1];
  }
  for (int p = 2 * (end > begin ? end : begin); p < line.fine; ++p)
    fine[p] = weighted(line.parents[p], coarse);
}

/// coarse = P^T fine along a line.
CLOTHLAB_INLINE void gather(const CoarseLine& line, const float* fine, float* coarse) {
  const float* mask = line.mask;
  const int begin = line.regular_end > 0 ? (line.regular_begin + 3) / 2 : line.coarse;
  const int end = (line.regular_end - 1) / 2;
  for (int i = 0; i < begin; ++i) coarse[i] = weighted(line.children[i], fine);
  for (int i = begin; i < end; ++i)
    coarse[i] = mask[0] * fine[2 * i - 2] + mask[1] * fine[2 * i - 1] + mask[2] * fine[2 * i] +
                mask[3] * fine[2 * i + 1] + mask[4] * fine[2 * i + 2];
  for (int i = end > begin ? end : begin; i < line.coarse; ++i) coarse[i] = weighted(line.children[i], fine);
}

/// A row's numbers from groups, in the order of columns, then those of unused lanes.
CLOTHLAB_INLINE void put_in_order(const BlockLevel& l, const float* from, float* to) {
  for (int group = 0; group < l.groups; ++group) {
    const Eight v = read(from + group * BlockLevel::vector_group);
    for (int lane = 0; lane < lanes; ++lane) to[lane * l.groups + group] = v[lane];
  }
}

/// The numbers of a group from a row in the order of columns.
CLOTHLAB_INLINE Eight take_group(const BlockLevel& l, int group, const float* from) {
  const float* p = from + group;
  const int n = l.groups;
  return Eight{p[0], p[n], p[2 * n], p[3 * n], p[4 * n], p[5 * n], p[6 * n], p[7 * n]};
}

/// The lanes of a group that have a particle.
CLOTHLAB_INLINE int used_lanes(const BlockLevel& l, int group) {
  return (l.columns - group + l.groups - 1) / l.groups;
}

void set_right_side(const BlockLevel& l, const BlockField& field, const double* const* of) {
  const std::ptrdiff_t next_lane = l.groups * field.next_column;
  for (int row = 0; row < l.rows; ++row)
    for (int group = 0; group < l.groups; ++group) {
      const std::ptrdiff_t first = row * field.next_row + group * field.next_column;
      float* to = l.b + row * l.vector_row + group * BlockLevel::vector_group;
      const int used = used_lanes(l, group);
      for (int n = 0; n < 3; ++n, to += lanes)
        for (int lane = 0; lane < lanes; ++lane)
          to[lane] = lane < used ? static_cast<float>(of[n][first + lane * next_lane]) : 0;
    }
}

void get_solution(const BlockLevel& l, const BlockField& field, double* const* to) {
  const std::ptrdiff_t next_lane = l.groups * field.next_column;
  for (int row = 0; row < l.rows; ++row)
    for (int group = 0; group < l.groups; ++group) {
      const std::ptrdiff_t first = row * field.next_row + group * field.next_column;
      const float* from = l.x + row * l.vector_row + group * BlockLevel::vector_group;
      const int used = used_lanes(l, group);
      for (int n = 0; n < 3; ++n, from += lanes)
        for (int lane = 0; lane < used; ++lane) to[n][first + lane * next_lane] = from[lane];
    }
}

void restrict_residual(const BlockLevel& fine, const BlockLevel& coarse, const BlockTransfer& transfer) {
  const std::ptrdiff_t numbers = fine.groups * BlockLevel::vector_group;
  float *sums = transfer.scratch, *of_fine = sums + numbers, *of_coarse = of_fine + numbers;
  for (int row = 0; row < coarse.rows; ++row) {
    add_rows(transfer.rows.children[row], fine.r, fine.vector_row, numbers, sums);
    float* to = coarse.b + row * coarse.vector_row;
    for (int n = 0; n < 3; ++n, to += lanes) {
      put_in_order(fine, sums + n * lanes, of_fine);
      gather(transfer.columns, of_fine, of_coarse);
      clear_unused(coarse, of_coarse);
      for (int group = 0; group < coarse.groups; ++group)
        write(to + group * BlockLevel::vector_group, take_group(coarse, group, of_coarse));
    }
  }
}

void add_correction(const BlockLevel& fine, const BlockLevel& coarse, const BlockTransfer& transfer) {
  const std::ptrdiff_t numbers = coarse.groups * BlockLevel::vector_group;
  const std::ptrdiff_t fine_numbers = fine.groups * lanes;
  float *sums = transfer.scratch, *of_coarse = sums + numbers + 1, *of_fine = of_coarse + numbers + 1;
  for (int row = 0; row < fine.rows; ++row) {
    add_rows(transfer.rows.parents[row], coarse.x, coarse.vector_row, numbers, sums);
    for (int n = 0; n < 3; ++n) {
      put_in_order(coarse, sums + n * lanes, of_coarse);
      of_coarse[-1] = of_coarse[coarse.columns] = 0;
      interpolate(transfer.columns, of_coarse, of_fine + n * fine_numbers);
      clear_unused(fine, of_fine + n * fine_numbers);
    }
    float* x = fine.x + row * fine.vector_row;
    for (int group = 0; group < fine.groups; ++group, x += BlockLevel::vector_group) {
      const ThreeFloats correction{take_group(fine, group, of_fine),
                                   take_group(fine, group, of_fine + fine_numbers),
                                   take_group(fine, group, of_fine + 2 * fine_numbers)};
      const ThreeFloats corrected = read_vector(x) + correction;
      write_vector(x, corrected);
      write_copies(fine, group, corrected, x);
    }
  }
}

constexpr BlockCycleKernels table{set_right_side, get_solution,      descend,
                                  ascend,         restrict_residual, add_correction};

}  // namespace

const BlockCycleKernels& BlockCycleKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
