#include "support/count_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

thread_local clothlab::test::Allocations counted;
thread_local bool is_spared = false;
std::atomic<std::size_t> least_refused{0};
std::atomic<long> left_until_refusal{0};  ///< 0: none is refused, or it has happened

}  // namespace

clothlab::test::Allocations clothlab::test::allocations_of_this_thread() {
  return counted;
}

clothlab::test::RefusedAllocation::RefusedAllocation(long number, std::size_t bytes) {
  is_spared = true;
  least_refused = bytes;
  left_until_refusal = number;
}

clothlab::test::RefusedAllocation::~RefusedAllocation() {
  left_until_refusal = 0;
  is_spared = false;
}

bool clothlab::test::RefusedAllocation::has_happened() const {
  return left_until_refusal <= 0;
}

// The other forms of new and delete that are not over-aligned call these; but a sanitizer has a nothrow new
// of its own, whose memory must not come here to be freed.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++counted.calls;
  counted.bytes += size;
  if (left_until_refusal > 0 && !is_spared && size >= least_refused && --left_until_refusal == 0)
    return nullptr;
  return std::malloc(size > 0 ? size : 1);
}

void* operator new(std::size_t size) {
  if (void* const memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
