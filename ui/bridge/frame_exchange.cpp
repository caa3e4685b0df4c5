#include "bridge/frame_exchange.h"

namespace clothlab {

FrameExchange::FrameExchange() : pool_(std::make_shared<Pool>()) {}

std::shared_ptr<ClothFrame> FrameExchange::blank() {
  std::unique_ptr<ClothFrame> frame;
  {
    const std::lock_guard lock(pool_->mutex);
    if (!pool_->idle.empty()) {
      frame = std::move(pool_->idle.back());
      pool_->idle.pop_back();
    }
  }
  if (!frame) frame = std::make_unique<ClothFrame>();
  return {frame.release(), [pool = pool_](ClothFrame* used) {
            std::unique_ptr<ClothFrame> back(used);
            const std::lock_guard lock(pool->mutex);
            pool->idle.push_back(std::move(back));
          }};
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
