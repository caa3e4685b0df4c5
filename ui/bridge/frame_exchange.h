// Frames from the worker to the window: newest wins, and the memory of a frame that is no longer shown
// is used again, its reference count included: once a few frames have gone round, none allocates.
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

  std::shared_ptr<Pool> pool_;  ///< shared with the frames: one may outlive the exchange
  std::mutex mutex_;
  std::shared_ptr<const ClothFrame> newest_;
};

}  // namespace clothlab
