#include "contact/closest_kernels.h"

#include "kernels/three.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth {
namespace {

constexpr int width = kernels::register_width;
constexpr double slender = 1e-8;  ///< as in closest_points.h

using V [[gnu::vector_size(8 * width)]] = double;
using Mask = decltype(V{} < V{});

using Vector = kernels::Three<V>;

CLOTHLAB_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
CLOTHLAB_INLINE V all(double value) {
  return value - V{};
}
CLOTHLAB_INLINE V choose(Mask mask, V a, V b) {
  return mask ? a : b;
}
CLOTHLAB_INLINE V clamped(V t) {
  const V low = choose(t > 0, t, V{});
  return choose(low < 1, low, all(1));
}
/// part / whole within [0, 1], and 0 without a whole.
CLOTHLAB_INLINE V share(V part, V whole) {
  return choose(whole > 0, clamped(part / whole), V{});
}
CLOTHLAB_INLINE V load(const double* p) {
  V v;
  __builtin_memcpy(&v, __builtin_assume_aligned(p, sizeof v), sizeof v);
  return v;
}
CLOTHLAB_INLINE void store(double* p, V v) {
  __builtin_memcpy(__builtin_assume_aligned(p, sizeof v), &v, sizeof v);
}
CLOTHLAB_INLINE Vector point_of(const ClosestBlock& block, int which, int k) {
  return {load(block.point[which][0] + k), load(block.point[which][1] + k), load(block.point[which][2] + k)};
}

/// The closest of several, the first of equal ones.
struct Closest {
  V first{}, second{};
  Vector separation{};
  V square = all(__builtin_huge_val());

  CLOTHLAB_INLINE void consider(V s, V t, const Vector& apart, Mask among) {
    const V d = dot(apart, apart);
    const Mask better = among & (d < square);
    first = choose(better, s, first), second = choose(better, t, second);
    separation = {choose(better, apart.x, separation.x), choose(better, apart.y, separation.y),
                  choose(better, apart.z, separation.z)};
    square = choose(better, d, square);
  }
  CLOTHLAB_INLINE void store_to(ClosestBlock& block, int k) const {
    store(block.separation[0] + k, separation.x), store(block.separation[1] + k, separation.y);
    store(block.separation[2] + k, separation.z), store(block.squared_distance + k, square);
  }
};

CLOTHLAB_INLINE void note_sound(Mask is_sound, ClosestBlock& block, int k) {
  store(block.is_sound + k, choose(is_sound, all(1), V{}));
}

CLOTHLAB_INLINE void of_segments_at(ClosestBlock& block, int k) {
  const V none{}, one = all(1);
  const Mask always = none == none;
  const Vector a = point_of(block, 0, k), c = point_of(block, 2, k);
  const Vector first = point_of(block, 1, k) - a, second = point_of(block, 3, k) - c, apart = a - c;
  const Vector normal = cross(first, second);
  const V square = dot(normal, normal);
  const V s = dot(cross(second, apart), normal), t = dot(cross(first, apart), normal);
  const Mask inside = (s > 0) & (s < square) & (t > 0) & (t < square);
  const V first_square = dot(first, first), second_square = dot(second, second);
  const auto apart_at = [&](V u, V v) { return (apart + u * first) - v * second; };
  Closest best;
  const V at_a = share(dot(apart, second), second_square);
  best.consider(none, at_a, apart_at(none, at_a), always);
  const V at_b = share(dot(apart + first, second), second_square);
  best.consider(one, at_b, apart_at(one, at_b), always);
  const V at_c = share(dot(-1 * one * apart, first), first_square);
  best.consider(at_c, none, apart_at(at_c, none), always);
  const V at_d = share(dot(second - apart, first), first_square);
  best.consider(at_d, one, apart_at(at_d, one), always);
  const V u = clamped(s / square), v = clamped(t / square);
  best.square = choose(inside, all(__builtin_huge_val()), best.square);
  best.consider(u, v, apart_at(u, v), inside);
  store(block.weight[0] + k, best.first), store(block.weight[1] + k, best.second);
  best.store_to(block, k);
  note_sound(~inside | (square > slender * first_square * second_square), block, k);
}

/// Edge k lies opposite vertex k.
CLOTHLAB_INLINE void on_triangles_at(ClosestBlock& block, int k) {
  const Vector p = point_of(block, 0, k), a = point_of(block, 1, k), b = point_of(block, 2, k),
               c = point_of(block, 3, k);
  const Vector ab = b - a, ac = c - a, apart = p - a;
  const Vector normal = cross(ab, ac);
  const V square = dot(normal, normal);
  const V to_b = dot(cross(apart, ac), normal), to_c = dot(cross(ab, apart), normal);
  const V to_a = square - to_b - to_c;
  const Mask inside = (to_a >= 0) & (to_b >= 0) & (to_c >= 0) & (square > 0);
  Closest best;  // `first`: the weight along the edge, `second`: which edge
  const auto consider_edge = [&](double which, const Vector& from, const Vector& along, Mask beyond) {
    const V weight = share(dot(from, along), dot(along, along));
    best.consider(weight, all(which), from - weight * along, beyond);
  };
  consider_edge(0, p - b, c - b, to_a < 0);
  consider_edge(1, p - c, a - c, to_b < 0);
  consider_edge(2, apart, ab, to_c < 0);
  const V weight = best.first, rest = 1 - weight;
  const Mask on_bc = best.second == 0, on_ca = best.second == 1;
  const V u = clamped(to_b / square), v = clamped(to_c / square);
  best.square = choose(inside, all(__builtin_huge_val()), best.square);
  best.consider(V{}, V{}, (apart - u * ab) - v * ac, inside);
  const V of_a = choose(on_bc, V{}, choose(on_ca, weight, rest)),
          of_b = choose(on_bc, rest, choose(on_ca, V{}, weight)),
          of_c = choose(on_bc, weight, choose(on_ca, rest, V{}));
  store(block.weight[0] + k, choose(inside, clamped(1 - u - v), of_a));
  store(block.weight[1] + k, choose(inside, u, of_b));
  store(block.weight[2] + k, choose(inside, v, of_c));
  best.store_to(block, k);
  note_sound(square > slender * dot(ab, ab) * dot(ac, ac), block, k);
}

void of_segments(ClosestBlock& block) {
  for (int k = 0; k < ClosestBlock::size; k += width) of_segments_at(block, k);
}

void on_triangles(ClosestBlock& block) {
  for (int k = 0; k < ClosestBlock::size; k += width) on_triangles_at(block, k);
}

constexpr ClosestKernels table{of_segments, on_triangles};

}  // namespace

const ClosestKernels& ClosestKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
