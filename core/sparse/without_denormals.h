// Numbers near the smallest of their type, as they occur in single precision far from where a force acts:
// processors take a hundred times as long with them.
#pragma once

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace cloth {

/// While one lives such numbers count as zero on this thread, where the processor can do that.
class WithoutDenormals {
 public:
#ifdef __SSE2__
  WithoutDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | flush_to_zero | denormals_are_zero);
  }
  ~WithoutDenormals() {
    _mm_setcsr(before_);
  }
#else
  WithoutDenormals() {}
  ~WithoutDenormals() {}
#endif
  WithoutDenormals(const WithoutDenormals&) = delete;
  WithoutDenormals& operator=(const WithoutDenormals&) = delete;

 private:
#ifdef __SSE2__
  static constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  unsigned before_;
#endif
};

}  // namespace cloth
