#include "contact/bound_kernels.h"

#include "kernels/three.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth {
namespace {

constexpr int width = 2 * kernels::register_width;

using V [[gnu::vector_size(4 * width)]] = float;
using Mask = decltype(V{} < V{});
using Vector = kernels::Three<V>;

CLOTHLAB_INLINE V all(float value) {
  return value - V{};
}
CLOTHLAB_INLINE V choose(Mask mask, V a, V b) {
  return mask ? a : b;
}
CLOTHLAB_INLINE V larger(V a, V b) {
  return choose(a > b, a, b);
}
CLOTHLAB_INLINE V smaller(V a, V b) {
  return choose(a < b, a, b);
}
CLOTHLAB_INLINE V size_of(V a) {
  return larger(a, -a);
}
/// part / whole within [0, 1], and 0 without a whole.
CLOTHLAB_INLINE V share(V part, V whole) {
  return choose(whole > 0, smaller(larger(part / whole, V{}), all(1)), V{});
}
CLOTHLAB_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Of the four numbers in each quarter of two registers, as the names of x86 say.
#if defined(__AVX512F__)
CLOTHLAB_INLINE V unpacked_low(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
CLOTHLAB_INLINE V unpacked_high(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
CLOTHLAB_INLINE V low_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}
CLOTHLAB_INLINE V high_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}
#elif defined(__AVX2__)
CLOTHLAB_INLINE V unpacked_low(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
}
CLOTHLAB_INLINE V unpacked_high(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
}
CLOTHLAB_INLINE V low_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
}
CLOTHLAB_INLINE V high_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
}
#else
CLOTHLAB_INLINE V unpacked_low(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 4, 1, 5);
}
CLOTHLAB_INLINE V unpacked_high(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 6, 3, 7);
}
CLOTHLAB_INLINE V low_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 0, 1, 4, 5);
}
CLOTHLAB_INLINE V high_halves(V a, V b) {
  return __builtin_shufflevector(a, b, 2, 3, 6, 7);
}
#endif

/// A point in each quarter of a register: points[vertices[0]], [vertices[4]], ...
CLOTHLAB_INLINE V every_fourth(const RoundedPoint* points, const int* vertices) {
  using Point [[gnu::vector_size(16)]] = float;
  const auto load = [&](int k) __attribute__((always_inline)) {
    Point p;
    __builtin_memcpy(&p, __builtin_assume_aligned(points[vertices[4 * k]].of, 16), sizeof p);
    return p;
  };
#if defined(__AVX512F__)
  const auto pair = [&](int k) __attribute__((always_inline)) {
    return __builtin_shufflevector(load(k), load(k + 1), 0, 1, 2, 3, 4, 5, 6, 7);
  };
  return __builtin_shufflevector(pair(0), pair(2), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#elif defined(__AVX2__)
  return __builtin_shufflevector(load(0), load(1), 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return load(0);
#endif
}

/// Of as many pairs as a register has lanes, which are repeated where there are fewer. (To write coordinates
/// one by one and read them as registers would wait for all of these writes.)
struct Block {
  Vector point[4];

  CLOTHLAB_INLINE void load(int which, const RoundedPoint* from, const PairVertices* pairs, int count) {
    int vertices[width];
    for (int lane = 0; lane < width; ++lane) vertices[lane] = pairs[lane < count ? lane : 0].of[which];
    const V first = every_fourth(from, vertices), second = every_fourth(from, vertices + 1),
            third = every_fourth(from, vertices + 2), fourth = every_fourth(from, vertices + 3);
    const V xy_of_two = unpacked_low(first, second), xy_of_others = unpacked_low(third, fourth);
    point[which] = {low_halves(xy_of_two, xy_of_others), high_halves(xy_of_two, xy_of_others),
                    low_halves(unpacked_high(first, second), unpacked_high(third, fourth))};
  }
  CLOTHLAB_INLINE V largest_coordinate() const {
    V most{};
    for (const Vector& p : point)
      most = larger(most, larger(size_of(p.x), larger(size_of(p.y), size_of(p.z))));
    return most;
  }
};

/// The square of a distance along n, of which `along` is |n| times as much; 0 where that is negative, or
/// where n is so short that its square has lost digits.
CLOTHLAB_INLINE V square_of(V along, const Vector& n) {
  constexpr float least = 1e-24F;
  const V length = dot(n, n), ahead = larger(along, V{});
  return choose(length > least, ahead * ahead / length, V{});
}

/// Writes the bounds of the first `count` pairs of a block.
CLOTHLAB_INLINE void store(V square, V largest, int count, float* bounds) {
  // In parts of 2^-24 times the largest coordinate, along a unit normal: 3.5 by rounded coordinates, up to 28
  // (of triangles 40) by products with differences of them, some 9 by sums, the quotient and the root.
  constexpr float of_rounding = 64 / 16777216.0F;
  constexpr float of_squares = 1e-10F;  // m, where these are too small for all of their digits
  constexpr float too_large = 1e5F;     // m; its sixth power, and a thousand times that, is a number still
  alignas(64) float squares[width], coordinates[width];
  __builtin_memcpy(squares, &square, sizeof square);
  __builtin_memcpy(coordinates, &largest, sizeof largest);
  for (int lane = 0; lane < count; ++lane)
    bounds[lane] = coordinates[lane] < too_large
                       ? __builtin_sqrtf(squares[lane]) - (of_rounding * coordinates[lane] + of_squares)
                       : -__builtin_inff();
}

/// n: from the closest point of the second segment to that of the first (Ericson 2005, 5.1.9).
CLOTHLAB_INLINE V square_of_segments(const Block& block) {
  const Vector a = block.point[0], c = block.point[2];
  const Vector first = block.point[1] - a, second = block.point[3] - c, apart = a - c;
  const V first_square = dot(first, first), second_square = dot(second, second), both = dot(first, second);
  const V on_first = dot(first, apart), on_second = dot(second, apart);
  const V free =
      share(both * on_second - on_first * second_square, first_square * second_square - both * both);
  const V wanted = both * free + on_second;
  const V t = share(wanted, second_square);
  const V s = choose(wanted < 0, share(-on_first, first_square),
                     choose(wanted > second_square, share(both - on_first, first_square), free));
  const Vector n = (apart + s * first) - t * second;
  return square_of((dot(n, apart) + smaller(dot(n, first), V{})) - larger(dot(n, second), V{}), n);
}

/// The best of the triangle's normal and the directions from the closest points of its edges.
CLOTHLAB_INLINE V square_of_triangle(const Block& block) {
  const Vector p = block.point[0], a = block.point[1], b = block.point[2], c = block.point[3];
  const Vector ab = b - a, ac = c - a, apart = p - a, normal = cross(ab, ac);
  V best = square_of(size_of(dot(normal, apart)) - larger(size_of(dot(normal, ab)), size_of(dot(normal, ac))),
                     normal);
  const auto consider_edge = [&](const Vector& from, const Vector& along) __attribute__((always_inline)) {
    const Vector n = from - share(dot(from, along), dot(along, along)) * along;
    best = larger(best, square_of(dot(n, apart) - larger(larger(dot(n, ab), dot(n, ac)), V{}), n));
  };
  consider_edge(apart, ab);
  consider_edge(apart, ac);
  consider_edge(p - b, c - b);
  return best;
}

void of_segments(const RoundedPoint* near, const RoundedPoint* far, const PairVertices* pairs, int count,
                 float* bounds) {
  for (int k = 0; k < count; k += width) {
    const int here = count - k < width ? count - k : width;
    Block block;
    for (int which = 0; which < 4; ++which) block.load(which, which < 2 ? near : far, pairs + k, here);
    store(square_of_segments(block), block.largest_coordinate(), here, bounds + k);
  }
}

void of_triangles(const RoundedPoint* points, const RoundedPoint* corners, const PairVertices* pairs,
                  int count, float* bounds) {
  for (int k = 0; k < count; k += width) {
    const int here = count - k < width ? count - k : width;
    Block block;
    for (int which = 0; which < 4; ++which) block.load(which, which == 0 ? points : corners, pairs + k, here);
    store(square_of_triangle(block), block.largest_coordinate(), here, bounds + k);
  }
}

constexpr BoundKernels table{of_segments, of_triangles};

}  // namespace

const BoundKernels& BoundKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
