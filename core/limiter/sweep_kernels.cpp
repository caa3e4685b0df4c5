#include "limiter/sweep_kernels.h"

#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

using kernels::larger;

/// A register of doubles. What takes a `V` below is written once for it and for one double.
constexpr int width = kernels::register_width;
using Lanes [[gnu::vector_size(8 * width)]] = double;

template <class V>
CLOTHLAB_INLINE V load(const double* p) {
  V lanes;
  __builtin_memcpy(&lanes, p, sizeof lanes);
  return lanes;
}
template <class V>
CLOTHLAB_INLINE void store(double* p, V lanes) {
  __builtin_memcpy(p, &lanes, sizeof lanes);
}
CLOTHLAB_INLINE double root(double square) {
  return __builtin_sqrt(square);
}
CLOTHLAB_INLINE Lanes root(Lanes square) {
  Lanes result;
  for (int k = 0; k < width; ++k) result[k] = __builtin_sqrt(square[k]);
  return result;
}
CLOTHLAB_INLINE bool any(bool mask) {
  return mask;
}
template <class Mask>
CLOTHLAB_INLINE bool any(Mask mask) {
  long long found = 0;
  for (int k = 0; k < width; ++k) found |= mask[k];
  return found != 0;
}
/// Neighbours exchanged: 0 and 1, 2 and 3, ...
CLOTHLAB_INLINE Lanes swapped(Lanes a) {
#if defined(__AVX512F__)
  return __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6);
#elif defined(__AVX2__)
  return __builtin_shufflevector(a, a, 1, 0, 3, 2);
#else
  return __builtin_shufflevector(a, a, 1, 0);
#endif
}

template <class V>
struct Vector {
  V x, y, z;
  CLOTHLAB_INLINE Vector operator-(const Vector& b) const { return {x - b.x, y - b.y, z - b.z}; }
  CLOTHLAB_INLINE Vector operator+(const Vector& b) const { return {x + b.x, y + b.y, z + b.z}; }
  CLOTHLAB_INLINE V squared() const { return x * x + y * y + z * z; }
};
template <class V, class P>
CLOTHLAB_INLINE Vector<V> load(const P& p, long i) {
  return {load<V>(p.x + i), load<V>(p.y + i), load<V>(p.z + i)};
}
template <class V, class Mask>
CLOTHLAB_INLINE void store_where(Mask mask, const Points& p, long i, const Vector<V>& now,
                                 const Vector<V>& before) {
  store(p.x + i, mask ? now.x : before.x);
  store(p.y + i, mask ? now.y : before.y);
  store(p.z + i, mask ? now.z : before.z);
}

CLOTHLAB_INLINE Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
CLOTHLAB_INLINE double largest_lane(Lanes a) {
  double largest = a[0];
  for (int k = 1; k < width; ++k) largest = larger(a[k], largest);
  return largest;
}

template <class V>
CLOTHLAB_INLINE Vector<V> across(const ConstPoints& p, long i, long j) {
  return load<V>(p, j) - load<V>(p, i);
}

double longest(const SpringRow& row, double limit, ConstPoints p) {
  const long end = row.first + row.count, offset = row.offset;
  Lanes found = {};
  long i = row.first;
  for (; i + width <= end; i += width) found = larger(across<Lanes>(p, i, i + offset).squared(), found);
  double largest = largest_lane(found);
  for (; i < end; ++i) largest = larger(across<double>(p, i, i + offset).squared(), largest);
  return largest > limit * limit ? largest : 0;
}

template <class V>
struct Correction {
  double limit, half_relaxation;  ///< the limit in m
  V largest = {};                 ///< squared length in m^2 of the springs that were too long

  /// What each end of the springs d moves by, where one is longer than the limit; returns which are.
  CLOTHLAB_INLINE auto apply(Vector<V>& d) {
    const V squared = d.squared();
    const auto over = squared > limit * limit;
    if (!any(over)) return over;
    largest = over ? larger(squared, largest) : largest;
    const V length = root(squared);
    const V share = half_relaxation * ((length - limit) / length);
    d = {share * d.x, share * d.y, share * d.z};
    return over;
  }
};

/// Springs from one run of particles to another.
template <class V>
CLOTHLAB_INLINE void shorten_across(Correction<V>& correction, const Points& p, long i, long j) {
  const Vector<V> a = load<V>(p, i), b = load<V>(p, j);
  Vector<V> d = b - a;
  const auto over = correction.apply(d);
  if (!any(over)) return;
  store_where(over, p, i, a + d, a);
  store_where(over, p, j, b - d, b);
}

/// Springs between neighbours 0 and 1, 2 and 3, ...: every lane computes its own end.
CLOTHLAB_INLINE void shorten_pairs(Correction<Lanes>& correction, const Points& p, long i) {
  const Vector<Lanes> a = load<Lanes>(p, i);
  Vector<Lanes> d = Vector<Lanes>{swapped(a.x), swapped(a.y), swapped(a.z)} - a;
  const auto over = correction.apply(d);
  if (any(over)) store_where(over, p, i, a + d, a);
}

double shorten(const SpringRow& row, double limit, double relaxation, Points p) {
  Correction<Lanes> lanes{limit, 0.5 * relaxation};
  Correction<double> rest{limit, 0.5 * relaxation};
  long i = row.first, left = row.count;
  if (row.stride == 1)
    for (; left >= width; left -= width, i += width) shorten_across(lanes, p, i, i + row.offset);
  else
    for (; left >= width / 2; left -= width / 2, i += width) shorten_pairs(lanes, p, i);
  for (; left > 0; --left, i += row.stride) shorten_across(rest, p, i, i + row.offset);
  return larger(largest_lane(lanes.largest), rest.largest);
}

constexpr SweepKernels table{longest, shorten};

}  // namespace

const SweepKernels& SweepKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
