// The equation of one spring in floats, for the kernels of tensions (kernels/kernel_table.h). Legend:
// tension_rounds.h.
#pragma once

#include <cstdint>

#include "limiter/tension_kernels.h"

namespace cloth {
namespace {

/// 1/sqrt(a) for a >= 0, large but finite for 0: Newton's iteration from a guess that is linear in the
/// exponent (Lomont 2003), faster than a root and a division.
CLOTHLAB_INLINE double inverse_root(double a) {
  const auto bits = __builtin_bit_cast(std::uint64_t, a);
  double y = __builtin_bit_cast(double, std::uint64_t{0x5FE6EB50C7B537A9} - (bits >> 1));
  const double half = 0.5 * a;
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  return y * (1.5 - half * y * y);
}
CLOTHLAB_INLINE float inverse_root(float a) {
  const auto bits = __builtin_bit_cast(std::uint32_t, a);
  float y = __builtin_bit_cast(float, std::uint32_t{0x5F375A86} - (bits >> 1));
  const float half = 0.5f * a;
  y = y * (1.5f - half * y * y);
  y = y * (1.5f - half * y * y);
  return y * (1.5f - half * y * y);
}

/// A spring's direction and C, zeros unless it is over its limit or has a tension. C/limit is computed as
/// (q - 1)/(1 + sqrt(q)), q = |d|^2/limit^2, which keeps its relative accuracy where C is small.
struct Equation {
  float ax, ay, az, over;
  bool active;
};
struct EquationRule {
  double per_square;  ///< 1/limit^2
  double per_limit;
  float limit, softness;
};
inline EquationRule equation_rule(const SpringRule& rule) {
  return {1 / (rule.limit * rule.limit), 1 / rule.limit, static_cast<float>(rule.limit),
          static_cast<float>(rule.softness)};
}
CLOTHLAB_INLINE Equation equation_of(const EquationRule& rule, double dx, double dy, double dz, double t,
                                     float both) {
  const double q = (dx * dx + dy * dy + dz * dz) * rule.per_square;
  const float ratio = static_cast<float>(q), inverse = inverse_root(ratio);
  const float beyond = static_cast<float>(q - 1);
  const float tension = static_cast<float>(t);
  const float over = beyond / (1 + ratio * inverse) * rule.limit - rule.softness * both * tension;
  const bool active = (tension > 0 || over > 0) && both > 0;
  const float scale = active ? inverse : 0.0f;
  return {scale * static_cast<float>(dx * rule.per_limit), scale * static_cast<float>(dy * rule.per_limit),
          scale * static_cast<float>(dz * rule.per_limit), over, active};
}

}  // namespace
}  // namespace cloth
