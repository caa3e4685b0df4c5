// The kernels once for all instruction sets. A translation unit defines a type `Lanes` of `width` doubles and
// includes this. Nothing else may be included there: a library's inline function compiled for one processor
// could be linked into what runs on another.
//
// Lanes has: width; load(p), store(p), broadcast(a); swapped(), which exchanges neighbours 0 and 1, 2 and 3,
// ...;
// + - * /; root(); larger_of(a, b), which is b where one of them is not a number; over(limit), a mask of the
// lanes above it; any(mask); chosen(mask, a, b), a in the lanes of the mask.
#pragma once

#include "limiter/sweep_kernels.h"

namespace cloth {
namespace {

/// One double: what is left over at the end of a row.
struct OneLane {
  static constexpr int width = 1;
  using Mask = bool;
  double value;
  static OneLane load(const double* p) { return {*p}; }
  static OneLane broadcast(double a) { return {a}; }
  void store(double* p) const { *p = value; }
  friend OneLane operator+(OneLane a, OneLane b) { return {a.value + b.value}; }
  friend OneLane operator-(OneLane a, OneLane b) { return {a.value - b.value}; }
  friend OneLane operator*(OneLane a, OneLane b) { return {a.value * b.value}; }
  friend OneLane operator/(OneLane a, OneLane b) { return {a.value / b.value}; }
  OneLane root() const { return {__builtin_sqrt(value)}; }
  Mask over(OneLane limit) const { return value > limit.value; }
  static bool any(Mask mask) { return mask; }
  static OneLane chosen(Mask mask, OneLane a, OneLane b) { return mask ? a : b; }
  static OneLane larger_of(OneLane a, OneLane b) { return a.value > b.value ? a : b; }
};

template <class V>
struct Triple {
  V x, y, z;
  V squared_length() const { return x * x + y * y + z * z; }
};

template <class V, class P>
Triple<V> load(const P& p, long i) {
  return {V::load(p.x + i), V::load(p.y + i), V::load(p.z + i)};
}

template <class V>
Triple<V> difference(const Triple<V>& a, const Triple<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class V>
double largest_lane(V v) {
  double lanes[V::width];
  v.store(lanes);
  double largest = lanes[0];
  for (int k = 1; k < V::width; ++k) largest = lanes[k] > largest ? lanes[k] : largest;
  return largest;
}

double larger(double a, double b) {
  return a > b ? a : b;
}

template <class V>
V squared_length(ConstPoints p, long i, long j) {
  return difference(load<V>(p, j), load<V>(p, i)).squared_length();
}

template <class V>
double longest(const SpringRow& row, double limit, ConstPoints p) {
  const long end = row.first + row.count, offset = row.offset;
  const V squared_limit = V::broadcast(limit * limit);
  V found = squared_limit;
  long i = row.first;
  for (; i + V::width <= end; i += V::width) found = V::larger_of(squared_length<V>(p, i, i + offset), found);
  double largest = V::any(found.over(squared_limit)) ? largest_lane(found) : 0;
  for (; i < end; ++i) {
    const double squared = squared_length<OneLane>(p, i, i + offset).value;
    if (squared > limit * limit) largest = larger(squared, largest);
  }
  return largest;
}

template <class V>
struct Correction {
  V limit, squared_limit, half_relaxation;
  V longest = V::broadcast(0);
  Correction(double limit_, double relaxation)
      : limit(V::broadcast(limit_)),
        squared_limit(V::broadcast(limit_ * limit_)),
        half_relaxation(V::broadcast(0.5 * relaxation)) {}

  /// The part of the spring that each end moves by, where `mask`.
  V share(V squared, typename V::Mask mask) {
    longest = V::chosen(mask, V::larger_of(squared, longest), longest);
    const V length = squared.root();
    return half_relaxation * ((length - limit) / length);
  }
};

template <class V>
void store(typename V::Mask mask, const Triple<V>& moved, const Triple<V>& old, Points p, long i) {
  V::chosen(mask, moved.x, old.x).store(p.x + i);
  V::chosen(mask, moved.y, old.y).store(p.y + i);
  V::chosen(mask, moved.z, old.z).store(p.z + i);
}

/// Springs from one run of particles to another one.
template <class V>
void shorten_across(Correction<V>& correction, Points p, long i, long j) {
  const Triple<V> a = load<V>(p, i), b = load<V>(p, j);
  const Triple<V> d = difference(b, a);
  const V squared = d.squared_length();
  const auto mask = squared.over(correction.squared_limit);
  if (!V::any(mask)) return;
  const V share = correction.share(squared, mask);
  const Triple<V> shift{share * d.x, share * d.y, share * d.z};
  store(mask, {a.x + shift.x, a.y + shift.y, a.z + shift.z}, a, p, i);
  store(mask, {b.x - shift.x, b.y - shift.y, b.z - shift.z}, b, p, j);
}

/// Springs between neighbours 0 and 1, 2 and 3, ...: every lane computes its own end.
template <class V>
void shorten_pairs(Correction<V>& correction, Points p, long i) {
  const Triple<V> a = load<V>(p, i);
  const Triple<V> d = difference({a.x.swapped(), a.y.swapped(), a.z.swapped()}, a);
  const V squared = d.squared_length();
  const auto mask = squared.over(correction.squared_limit);
  if (!V::any(mask)) return;
  const V share = correction.share(squared, mask);
  store(mask, {a.x + share * d.x, a.y + share * d.y, a.z + share * d.z}, a, p, i);
}

template <class V>
double shorten(const SpringRow& row, double limit, double relaxation, Points p) {
  Correction<V> correction(limit, relaxation);
  Correction<OneLane> rest(limit, relaxation);
  const long offset = row.offset;
  long i = row.first, left = row.count;
  if constexpr (V::width > 1) {
    if (row.stride == 1)
      for (; left >= V::width; left -= V::width, i += V::width) shorten_across(correction, p, i, i + offset);
    else
      for (; left >= V::width / 2; left -= V::width / 2, i += V::width) shorten_pairs(correction, p, i);
  }
  for (; left > 0; --left, i += row.stride) shorten_across(rest, p, i, i + offset);
  return larger(largest_lane(correction.longest), rest.longest.value);
}

/// (l1 - L)^2 - (l0 - L)^2 without the difference of two squares
template <class V>
V stretching_of(V rest_length, ConstPoints before, ConstPoints after, long i, long j) {
  const V old_length = squared_length<V>(before, i, j).root(), length = squared_length<V>(after, i, j).root();
  return (length - old_length) * ((length - rest_length) + (old_length - rest_length));
}

template <class V>
double stretching(const SpringRow& row, double rest_length, ConstPoints before, ConstPoints after) {
  constexpr int parts = 8, registers = parts / V::width;
  V sum[registers];
  for (V& part : sum) part = V::broadcast(0);
  const long end = row.first + row.count, offset = row.offset;
  long i = row.first;
  for (; i + parts <= end; i += parts)
    for (int k = 0; k < registers; ++k) {
      const long at = i + k * V::width;
      sum[k] = sum[k] + stretching_of(V::broadcast(rest_length), before, after, at, at + offset);
    }
  double s[parts];
  for (int k = 0; k < registers; ++k) sum[k].store(s + k * V::width);
  for (int k = 0; i < end; ++i, ++k)
    s[k] += stretching_of(OneLane{rest_length}, before, after, i, i + offset).value;
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

template <class V>
constexpr SweepKernels kernels_of(const char* instruction_set) {
  return {instruction_set, longest<V>, shorten<V>, stretching<V>};
}

}  // namespace
}  // namespace cloth
