#include "support/count_allocations.h"

#include <cstdlib>
#include <new>

namespace {

thread_local clothlab::test::Allocations counted;

}  // namespace

clothlab::test::Allocations clothlab::test::allocations_of_this_thread() {
  return counted;
}

// The other forms of new and delete that are not over-aligned call these; but a sanitizer has a nothrow new of
// its own, whose memory must not come here to be freed.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++counted.calls;
  counted.bytes += size;
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
