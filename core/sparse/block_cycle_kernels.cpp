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
  const int count = (l.columns - colour + l.colours - 1) / l.colours;
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
  for (int turn = 0; turn < l.colours; ++turn) {
    const int c = forward ? turn : l.colours - 1 - turn;
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
  for (int c = 0; c < l.colours; ++c) {
    const BlockLevel::Colour& colour = l.colour[c];
    for_each_register(l, row, c, [&](std::ptrdiff_t v, std::ptrdiff_t b, std::ptrdiff_t) {
      const ThreeFloats none{Floats{}, Floats{}, Floats{}};
      write_vector(l.r + v, l.width,
                   less_neighbours(l, colour, colour.earlier, colour.all, l.x + v, l.blocks + b, none));
    });
  }
}

void descend(const BlockLevel& l) {
  const int reach = l.colours - 1;
  for (int row = 0; row < l.rows + reach; ++row) {
    if (row < l.rows) solve_row<true>(l, row);
    if (row >= reach) residual_row(l, row - reach);  // its later neighbours are solved, and in the cache
  }
}

void ascend(const BlockLevel& l) {
  for (int row = l.rows - 1; row >= 0; --row) solve_row<false>(l, row);
}

constexpr BlockCycleKernels table{descend, ascend};

}  // namespace

const BlockCycleKernels& BlockCycleKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
