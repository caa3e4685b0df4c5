// The programs' own operator new: as the library's, but that it notes the size of a request which the system
// refuses, so that the message can name it. Sanitizers have their own.
#include <cstdlib>
#include <new>

#include "io/process.h"

// GCC and Clang say differently that a sanitizer is in.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CLOTHLAB_SANITIZER_ALLOCATES
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CLOTHLAB_SANITIZER_ALLOCATES
#endif
#endif

#ifndef CLOTHLAB_SANITIZER_ALLOCATES

// The other forms of new call these two, and the other forms of delete likewise.
void* operator new(std::size_t size) {
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  cloth::note_refused_memory(size);
  throw std::bad_alloc();
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  void* memory = nullptr;
  if (::posix_memalign(&memory, static_cast<std::size_t>(alignment), size > 0 ? size : 1) == 0) return memory;
  cloth::note_refused_memory(size);
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#endif
