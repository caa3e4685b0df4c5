// Two lanes by the compiler's vectors, on any processor: what every other Lanes type must do.
//
// load(p, count, otherwise): lanes from `count` on come from `otherwise`, and memory behind is not touched.
// shift_one(before, now): every lane moves one column to the right, the last one of `before` comes in first.
// spring_scale(s, k): k - k L / sqrt(s), and k where s is 0.
#pragma once

namespace cloth::kernels {
namespace {

struct Lanes {
  static constexpr int width = 2;
  static constexpr unsigned divided = 63;  ///< the springs whose roots are divided, here all
  typedef double V __attribute__((vector_size(16)));
  struct Spring {
    double stiffness, rest_tension;
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
  static V shift_one(V before, V now) { return V{before[1], now[0]}; }
  static V shift_two(V before, V) { return before; }
  static double sum(V a) { return a[0] + a[1]; }
  static Spring spring(double stiffness, double rest_tension) { return {stiffness, rest_tension}; }
  static double scale_of(double s, const Spring& spring) {
    const double part = spring.rest_tension / __builtin_sqrt(s);
    return spring.stiffness - (s == 0 ? 0 : part);
  }
  template <bool Divide>
  static V spring_scale(V s, const Spring& spring) {
    return V{scale_of(s[0], spring), scale_of(s[1], spring)};
  }
};

}  // namespace
}  // namespace cloth::kernels
