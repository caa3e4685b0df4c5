// How often and for how much this thread has asked operator new, and a way to refuse one request. A program
// that links count_allocations.cpp has its operator new replaced by one that counts.
#pragma once

#include <cstddef>

namespace clothlab::test {

struct Allocations {
  long calls = 0;
  std::size_t bytes = 0;
};

/// Since the thread began.
Allocations allocations_of_this_thread();

/// While it lives, the `number`-th allocation (from 1) of at least `bytes` of all threads but the one that
/// made it fails, once.
class RefusedAllocation {
 public:
  RefusedAllocation(long number, std::size_t bytes);
  ~RefusedAllocation();
  RefusedAllocation(const RefusedAllocation&) = delete;
  RefusedAllocation& operator=(const RefusedAllocation&) = delete;
  bool has_happened() const;
};

/// What `work` allocates on this thread.
template <class Work>
Allocations allocations_of(Work work) {
  const Allocations before = allocations_of_this_thread();
  work();
  const Allocations after = allocations_of_this_thread();
  return {after.calls - before.calls, after.bytes - before.bytes};
}

}  // namespace clothlab::test
