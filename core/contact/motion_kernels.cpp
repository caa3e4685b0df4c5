#include "contact/motion_kernels.h"

namespace cloth {
namespace {

using Bits = unsigned long long;

constexpr long block = 256;  // lengths that are still in the nearest cache when their maximum is found

CLOTHLAB_INLINE Bits bits_of(double value) {
  Bits bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Of numbers that are at least 0, side by side: a compiler may not change the order in which a maximum of
/// floating point numbers is found.
double largest_of(const double* values, long count) {
  constexpr long lanes = 8;
  double most[lanes] = {};
  long k = 0;
  for (; k + lanes <= count; k += lanes)
    for (long lane = 0; lane < lanes; ++lane)
      most[lane] = values[k + lane] > most[lane] ? values[k + lane] : most[lane];
  for (; k < count; ++k) most[0] = values[k] > most[0] ? values[k] : most[0];
  for (long lane = 1; lane < lanes; ++lane) most[0] = most[lane] > most[0] ? most[lane] : most[0];
  return most[0];
}

double find_lengths(Components from, Components to, long count, double* lengths) {
  double most = 0;
  for (long begin = 0; begin < count; begin += block) {
    const long end = begin + block < count ? begin + block : count;
    for (long k = begin; k < end; ++k) {
      const double x = to.x[k] - from.x[k], y = to.y[k] - from.y[k], z = to.z[k] - from.z[k];
      lengths[k] = __builtin_sqrt(x * x + y * y + z * z);
    }
    const double here = largest_of(lengths + begin, end - begin);
    most = here > most ? here : most;
  }
  return most;
}

void find_mean_speed(const double* to, const double* from, double step, long count, double* speed) {
  for (long k = 0; k < count; ++k) speed[k] = (to[k] - from[k]) / step;
}

bool are_within(const double* moved, const double* range, double most, const double* allowed,
                const double* beside, long count) {
  long long beyond = 0;
  for (long k = 0; k < count; ++k) {
    beyond |= moved[k] + range[k] <= allowed[k] ? 0 : 1;
    beyond |= moved[k] + most <= beside[k] ? 0 : 1;
  }
  return beyond == 0;
}

bool differ(const double* a, const double* b, long count) {
  Bits any = 0;
  for (long k = 0; k < count; ++k) any |= bits_of(a[k]) ^ bits_of(b[k]);
  return any != 0;
}

/// The exponent's bits of infinity and of what is no number are all set: one more sets the sign's.
bool are_finite(const double* values, long count) {
  constexpr Bits exponent = 0x7ff0000000000000, one = 0x0010000000000000, sign = 0x8000000000000000;
  Bits any = 0;
  for (long k = 0; k < count; ++k) any |= (bits_of(values[k]) & exponent) + one;
  return (any & sign) == 0;
}

constexpr MotionKernels table{find_lengths, find_mean_speed, are_within, differ, are_finite};

}  // namespace

const MotionKernels& MotionKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
