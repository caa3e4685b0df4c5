#include "bridge/frame_exchange.h"

#include <cassert>
#include <cstddef>
#include <new>
#include <utility>

namespace clothlab {

/// A frame and room for the reference count of whoever holds it.
struct FrameExchange::Slot {
  static constexpr std::size_t count_size = 128;  // bytes; checked at compile time below
  ClothFrame frame;
  std::unique_ptr<Slot> next;  ///< in the list of idle slots
  alignas(std::max_align_t) std::byte count[count_size];
};

/// Slots are given back when their count is, which a shared_ptr does last of all.
struct FrameExchange::Pool {
  std::mutex mutex;
  std::unique_ptr<Slot> idle;  ///< the first of a list, as giving back must not allocate

  std::unique_ptr<Slot> take() {
    const std::lock_guard lock(mutex);
    if (!idle) return std::make_unique<Slot>();
    return std::exchange(idle, std::move(idle->next));
  }
  void give_back(std::unique_ptr<Slot> slot) {
    const std::lock_guard lock(mutex);
    slot->next = std::exchange(idle, nullptr);
    idle = std::move(slot);
  }
};

/// Puts the one object that a shared_ptr allocates, its count, into the slot.
template <typename T>
struct FrameExchange::SlotAllocator {
  using value_type = T;
  std::shared_ptr<Pool> pool;
  Slot* slot;

  SlotAllocator(std::shared_ptr<Pool> of, Slot* in) : pool(std::move(of)), slot(in) {}
  template <typename U>
  SlotAllocator(const SlotAllocator<U>& other)
      : pool(other.pool), slot(other.slot) {}  // NOLINT: as allocators convert

  T* allocate([[maybe_unused]] std::size_t objects) {
    static_assert(sizeof(T) <= Slot::count_size && alignof(T) <= alignof(std::max_align_t));
    assert(objects == 1);
    return reinterpret_cast<T*>(slot->count);
  }
  void deallocate(T*, std::size_t) { pool->give_back(std::unique_ptr<Slot>(slot)); }
  bool operator==(const SlotAllocator&) const = default;
};

FrameExchange::FrameExchange() : pool_(std::make_shared<Pool>()) {}

std::shared_ptr<ClothFrame> FrameExchange::blank() {
  Slot* slot = pool_->take().release();  // the allocator gives it back
  return {&slot->frame, [](ClothFrame*) {}, SlotAllocator<ClothFrame>(pool_, slot)};
}

void FrameExchange::publish(std::shared_ptr<const ClothFrame> frame) {
  const std::lock_guard lock(mutex_);
  newest_.swap(frame);  // the one before is given back after the lock
}

std::shared_ptr<const ClothFrame> FrameExchange::take() {
  const std::lock_guard lock(mutex_);
  return std::move(newest_);
}

}  // namespace clothlab
