// 3-vectors of SIMD registers: each lane holds one particle. Loads, stores and arithmetic. Included once for
// every instruction set, after its Lanes (lanes_*.h); everything here has internal linkage.
#pragma once

namespace cloth::kernels {
namespace {

using V = Lanes::V;

struct Vector {
  V x, y, z;
};

/// Pointers to the three components of a row of particles.
struct Row {
  double *x, *y, *z;
};
struct ConstRow {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  ConstRow() = default;
  ConstRow(Row row) : x(row.x), y(row.y), z(row.z) {}
  ConstRow(const double* px, const double* py, const double* pz) : x(px), y(py), z(pz) {}
};

CLOTHLAB_INLINE Vector load(const ConstRow& row, int j) {
  return {Lanes::load(row.x + j), Lanes::load(row.y + j), Lanes::load(row.z + j)};
}
CLOTHLAB_INLINE Vector load(const ConstRow& row, int j, int count, const Vector& otherwise) {
  return {Lanes::load(row.x + j, count, otherwise.x), Lanes::load(row.y + j, count, otherwise.y),
          Lanes::load(row.z + j, count, otherwise.z)};
}
CLOTHLAB_INLINE void store(const Row& row, int j, const Vector& a) {
  Lanes::store(row.x + j, a.x), Lanes::store(row.y + j, a.y), Lanes::store(row.z + j, a.z);
}
template <bool Edge>
CLOTHLAB_INLINE void store(const Row& row, int j, int count, const Vector& a) {
  if constexpr (Edge)
    Lanes::store(row.x + j, a.x, count), Lanes::store(row.y + j, a.y, count),
        Lanes::store(row.z + j, a.z, count);
  else
    store(row, j, a);
}
/// At an Edge the first `count` lanes, and zero in the others.
template <bool Edge>
CLOTHLAB_INLINE Vector load_part(const ConstRow& row, int j, int count) {
  const V zero = Lanes::zero();
  if constexpr (Edge) return load(row, j, count, {zero, zero, zero});
  return load(row, j);
}

CLOTHLAB_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {Lanes::sub(a.x, b.x), Lanes::sub(a.y, b.y), Lanes::sub(a.z, b.z)};
}
CLOTHLAB_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {Lanes::add(a.x, b.x), Lanes::add(a.y, b.y), Lanes::add(a.z, b.z)};
}
CLOTHLAB_INLINE Vector scaled(V s, const Vector& a) {
  return {Lanes::mul(s, a.x), Lanes::mul(s, a.y), Lanes::mul(s, a.z)};
}
/// c + s a, and c - s a
CLOTHLAB_INLINE Vector plus(const Vector& c, V s, const Vector& a) {
  return {Lanes::fma(s, a.x, c.x), Lanes::fma(s, a.y, c.y), Lanes::fma(s, a.z, c.z)};
}
CLOTHLAB_INLINE Vector minus(const Vector& c, V s, const Vector& a) {
  return {Lanes::fnma(s, a.x, c.x), Lanes::fnma(s, a.y, c.y), Lanes::fnma(s, a.z, c.z)};
}
CLOTHLAB_INLINE V product(const Vector& a, const Vector& b) {
  return Lanes::fma(a.z, b.z, Lanes::fma(a.y, b.y, Lanes::mul(a.x, b.x)));
}
CLOTHLAB_INLINE V squared(const Vector& a) {
  return product(a, a);
}
/// sum + |a|^2 lane by lane
CLOTHLAB_INLINE V plus_square(V sum, const Vector& a) {
  return Lanes::fma(a.z, a.z, Lanes::fma(a.y, a.y, Lanes::fma(a.x, a.x, sum)));
}
/// Moves every lane one or two columns to the right; the first lanes are filled with the last of `before`.
CLOTHLAB_INLINE Vector moved_one(const Vector& before, const Vector& now) {
  return {Lanes::shift_one(before.x, now.x), Lanes::shift_one(before.y, now.y),
          Lanes::shift_one(before.z, now.z)};
}
CLOTHLAB_INLINE Vector moved_two(const Vector& before, const Vector& now) {
  return {Lanes::shift_two(before.x, now.x), Lanes::shift_two(before.y, now.y),
          Lanes::shift_two(before.z, now.z)};
}
CLOTHLAB_INLINE Vector vector_of(const double* a) {
  return {Lanes::set(a[0]), Lanes::set(a[1]), Lanes::set(a[2])};
}

/// Which force along a spring is computed: elastic, elastic and damping, or damping alone.
enum class Law { elastic, damped, damper };

/// The particles of one block of lanes. `velocity` is set only for laws with a damper.
struct Particles {
  Vector position, velocity;
};

/// The damper of a spring, with d = to - from: returns s, so that the damping force on `from` is s d, in N/m,
/// and adds the dissipated power in W to `loss`. `inverse` is 1/|d|, or 0 where |d| = 0.
CLOTHLAB_INLINE V damper_scale(const Particles& from, const Particles& to, const Vector& d, V inverse,
                               V damping, V& loss) {
  const V opening =
      Lanes::mul(product(to.velocity - from.velocity, d), inverse);  // m/s, rate of change of length
  const V along = Lanes::mul(damping, opening);
  loss = Lanes::fma(along, opening, loss);
  return Lanes::mul(along, inverse);
}

/// The force before any spring is added: weight, plus the load (N) of each particle where there is one.
template <bool Edge>
CLOTHLAB_INLINE Vector initial(const ConstRow& load_row, const Vector& weight, int j, int count) {
  return load_row.x ? weight + load_part<Edge>(load_row, j, count) : weight;
}

}  // namespace
}  // namespace cloth::kernels
