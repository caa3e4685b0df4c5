#include "contact/motion_kernels.h"

#include "kernels/kernel_loops.h"

namespace cloth {
namespace {

using Bits = unsigned long long;

constexpr long block = 256;  // lengths that are still in the nearest cache when their maximum is found

CLOTHLAB_INLINE Bits bits_of(double value) {
  Bits bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Of numbers that are at least 0.
double largest_of(const double* values, long count) {
  double part[8] = {}, most = 0;
  kernels::in_parts<8>(count, [&](long k, int of) { part[of] = kernels::larger(values[k], part[of]); });
  for (const double of : part) most = kernels::larger(of, most);
  return most;
}

double find_lengths(Components from, Components to, long count, double* lengths) {
  double most = 0;
  for (long begin = 0; begin < count; begin += block) {
    const long end = begin + block < count ? begin + block : count;
    for (long k = begin; k < end; ++k) {
      const double x = to.x[k] - from.x[k], y = to.y[k] - from.y[k], z = to.z[k] - from.z[k];
      lengths[k] = __builtin_sqrt(x * x + y * y + z * z);
    }
    most = kernels::larger(largest_of(lengths + begin, end - begin), most);
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
