// How often and for how much this thread has asked operator new. A program that links count_allocations.cpp
// has its operator new replaced by one that counts.
#pragma once

#include <cstddef>

namespace clothlab::test {

struct Allocations {
  long calls = 0;
  std::size_t bytes = 0;
};

/// Since the thread began.
Allocations allocations_of_this_thread();

/// What `work` allocates on this thread.
template <class Work>
Allocations allocations_of(Work work) {
  const Allocations before = allocations_of_this_thread();
  work();
  const Allocations after = allocations_of_this_thread();
  return {after.calls - before.calls, after.bytes - before.bytes};
}

}  // namespace clothlab::test
