#include "support/count_allocations.h"

#include <cstdlib>
#include <new>

namespace {

thread_local clothlab::test::Allocations counted;

}  // namespace

clothlab::test::Allocations clothlab::test::allocations_of_this_thread() {
  return counted;
}

// The other forms of new and delete that are not over-aligned call these.
void* operator new(std::size_t size) {
  ++counted.calls;
  counted.bytes += size;
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
