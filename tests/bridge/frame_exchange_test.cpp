#include "bridge/frame_exchange.h"

#include <gtest/gtest.h>

#include <thread>

namespace clothlab::frame_exchange_test {
namespace {

TEST(FrameExchange, TheNewestFrameWins) {
  FrameExchange exchange;
  for (int step = 1; step <= 3; ++step) {
    const auto frame = exchange.blank();
    frame->step = step;
    exchange.publish(frame);
  }
  EXPECT_EQ(exchange.take()->step, 3);
  EXPECT_EQ(exchange.take(), nullptr);
}

TEST(FrameExchange, AFrameInUseIsNeverWrittenAgain) {
  FrameExchange exchange;
  const auto first = exchange.blank();
  exchange.publish(first);
  const auto seen = exchange.take();
  EXPECT_NE(exchange.blank().get(), seen.get());
}

TEST(FrameExchange, MemoryOfAFrameThatNobodyLooksAtIsUsedAgain) {
  FrameExchange exchange;
  const ClothFrame* memory = exchange.blank().get();  // given back at once
  EXPECT_EQ(exchange.blank().get(), memory);
}

TEST(FrameExchange, AFrameMayOutliveTheExchange) {
  std::shared_ptr<const ClothFrame> kept;
  {
    FrameExchange exchange;
    const auto frame = exchange.blank();
    frame->step = 7;
    exchange.publish(frame);
    kept = exchange.take();
  }
  EXPECT_EQ(kept->step, 7);
}

TEST(FrameExchange, AReaderSeesOnlyWholeFramesWhileAWriterPublishes) {
  FrameExchange exchange;
  constexpr int frames = 2000;
  std::jthread writer([&] {
    for (int step = 1; step <= frames; ++step) {
      const auto frame = exchange.blank();
      frame->positions.assign(64, static_cast<float>(step));
      frame->step = step;
      exchange.publish(frame);
    }
  });
  std::int64_t last = 0;
  while (last < frames) {
    const auto frame = exchange.take();
    if (!frame) continue;
    EXPECT_GT(frame->step, last);
    last = frame->step;
    for (const float value : frame->positions) ASSERT_EQ(value, static_cast<float>(last));
  }
}

}  // namespace
}  // namespace clothlab::frame_exchange_test
