// Two lanes with the vector types of GCC and Clang, for any processor: registers of SSE2 on x86-64. This is
// the reference for the other Lanes types, which have the same functions:
//
// load(p, count, otherwise): lanes from `count` on come from `otherwise`, and memory beyond the first `count`
// is not read. shift_one(before, now): every lane moves one column to the right, and the first lane is the
// last one of `before`. spring_scale(s, k): k - k L / sqrt(s), and k where s is 0. inverse_root(s): 1 /
// sqrt(s), and 0 where s is 0. scale_at(inverse_root(s), k): as spring_scale.
//
// any_positive(a): some lane is above 0.
//
// pairs_one(a, b, first, second): of the columns c, c + 1, ... in a and then b the first and the second ends
// of springs from c, c + 2, ... to the column beside; the order of lanes is the same in both, and
// unpair_one() brings them back. pairs_two: of springs from c, c + 1, c + 4, c + 5, ... to the column after
// the next.
//
// Only for general meshes:
// where_positive(k, a): a, and 0 where k is not positive.
// exact_scale(s, k, kL): as spring_scale, with another spring in each lane. scale(s, k, kL): the same but
// faster; it may be NaN where s is 0 or not finite. is_in_doubt(f): some lane is NaN.
// pick(table, kinds): looks up each lane's kind in a table of eight numbers.
// gather(vectors, at, x, y, z): loads the 4-vector x y z 0 at vectors + at[lane] into each lane.
// put(to, x, y, z): stores the lanes' 4-vectors one after the other.
#pragma once

namespace cloth::kernels {
namespace {

struct Lanes {
  static constexpr int width = 2;
  static constexpr unsigned divided =
      63;  ///< bits of the directions whose roots are computed by division: all
  typedef double V __attribute__((vector_size(16)));
  typedef long long Mask __attribute__((vector_size(16)));  ///< of a lane all bits, or none
  struct Spring {
    V stiffness, rest_tension;
  };

  static V set(double a) { return V{a, a}; }
  static V zero() { return V{0, 0}; }
  static V load(const double* p) { return V{p[0], p[1]}; }
  static V load(const double* p, int count, V otherwise) {
    return V{count > 0 ? p[0] : otherwise[0], count > 1 ? p[1] : otherwise[1]};
  }
  static void store(double* p, V a) { p[0] = a[0], p[1] = a[1]; }
  static void store(double* p, V a, int count) {
    if (count > 0) p[0] = a[0];
    if (count > 1) p[1] = a[1];
  }
  static V add(V a, V b) { return a + b; }
  static V sub(V a, V b) { return a - b; }
  static V mul(V a, V b) { return a * b; }
  /// a b + c, and c - a b. Here with two roundings.
  static V fma(V a, V b, V c) { return a * b + c; }
  static V fnma(V a, V b, V c) { return c - a * b; }
  static V div(V a, V b) { return a / b; }
  static V min(V a, V b) { return a < b ? a : b; }
  static V max(V a, V b) { return a > b ? a : b; }
  static V root(V a) { return V{__builtin_sqrt(a[0]), __builtin_sqrt(a[1])}; }
  /// a where the mask is set, and 0 elsewhere.
  static V where(Mask mask, V a) { return (V)(mask & (Mask)a); }
  static bool any(Mask mask) { return (mask[0] | mask[1]) != 0; }
  static bool any_positive(V a) { return any(a > zero()); }
  static void pairs_one(V a, V b, V& first, V& second) { first = V{a[0], b[0]}, second = V{a[1], b[1]}; }
  static void unpair_one(V first, V second, V& a, V& b) { pairs_one(first, second, a, b); }
  static void pairs_two(V a, V b, V& first, V& second) { first = a, second = b; }
  static void unpair_two(V first, V second, V& a, V& b) { a = first, b = second; }
  static V shift_one(V before, V now) { return V{before[1], now[0]}; }
  static V shift_two(V before, V) { return before; }
  static double sum(V a) { return a[0] + a[1]; }
  static Spring spring(double stiffness, double rest_tension) { return {set(stiffness), set(rest_tension)}; }
  template <bool Divide>
  static V spring_scale(V s, const Spring& spring) {
    return spring.stiffness - where(s != zero(), spring.rest_tension / root(s));
  }

  template <bool Divide>
  static V inverse_root(V s) {
    return where(s != zero(), set(1) / root(s));
  }
  static V scale_at(V inverse_root, const Spring& spring) {
    return fnma(spring.rest_tension, inverse_root, spring.stiffness);
  }

  static V where_positive(V k, V value) { return where(k > zero(), value); }
  static V scale(V s, V stiffness, V tension) { return stiffness - tension / root(s); }
  static V exact_scale(V s, V stiffness, V tension) { return spring_scale<true>(s, {stiffness, tension}); }
  static bool is_in_doubt(V force) { return any(force != force); }
  using Table = const double*;
  using Kinds = const unsigned char*;
  static Table table(const double* eight) { return eight; }
  static Kinds kinds(const unsigned char* p) { return p; }
  static V pick(Table table, Kinds k) { return V{table[k[0]], table[k[1]]}; }
  static void gather(const double* vectors, const int* at, V& x, V& y, V& z) {
    const double *a = vectors + at[0], *b = vectors + at[1];
    x = V{a[0], b[0]}, y = V{a[1], b[1]}, z = V{a[2], b[2]};
  }
  static void put(double* to, V x, V y, V z) {
    for (int lane = 0; lane < width; ++lane)
      to[4 * lane] = x[lane], to[4 * lane + 1] = y[lane], to[4 * lane + 2] = z[lane], to[4 * lane + 3] = 0;
  }
};

}  // namespace
}  // namespace cloth::kernels
