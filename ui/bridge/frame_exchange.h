// Passes frames from the worker's thread to the window's thread; the newest frame replaces older ones. The
// memory of frames that are no longer used is recycled, including the reference counts of the pointers: after
// a few frames nothing is allocated. All members are thread-safe.
#pragma once

#include <memory>
#include <mutex>

#include "bridge/frame.h"

namespace clothlab {

class FrameExchange {
 public:
  FrameExchange();

  /// A frame to fill; its vectors keep the capacity of an earlier use.
  std::shared_ptr<ClothFrame> blank();

  void publish(std::shared_ptr<const ClothFrame> frame);

  /// The newest frame that was not taken yet, or nullptr.
  std::shared_ptr<const ClothFrame> take();

 private:
  struct Slot;
  struct Pool;
  template <typename T>
  struct SlotAllocator;

  std::shared_ptr<Pool> pool_;  ///< shared with the frames, because a frame may outlive the exchange
  std::mutex mutex_;
  std::shared_ptr<const ClothFrame> newest_;
};

}  // namespace clothlab
