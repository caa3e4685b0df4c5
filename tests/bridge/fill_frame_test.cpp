#include "bridge/fill_frame.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bridge/frame_exchange.h"
#include "scene/builtin_scenes.h"
#include "support/count_allocations.h"

namespace clothlab::fill_frame_test {
namespace {

TEST(FillFrame, NormalsAreOfUnitLengthAndStrainsLargestIsTheLargest) {
  cloth::Simulation simulation(cloth::builtin_scene("wind"));
  for (int i = 0; i < 5; ++i) simulation.step();
  cloth::Vec3Field scratch;
  ClothFrame frame;
  fill_frame(simulation, simulation.state(), scratch, frame);
  const std::size_t particles = simulation.state().position.size();
  ASSERT_EQ(frame.positions.size(), 3 * particles);
  ASSERT_EQ(frame.normals.size(), 3 * particles);
  for (std::size_t i = 0; i < particles; ++i) {
    const float *n = &frame.normals[3 * i], *p = &frame.positions[3 * i];
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
    EXPECT_EQ(p[0], static_cast<float>(simulation.state().position[i].x()));
    EXPECT_EQ(p[2], static_cast<float>(simulation.state().position[i].z()));
  }
  EXPECT_GT(frame.largest_strain, 0);
  EXPECT_EQ(frame.largest_strain, *std::max_element(frame.strain.begin(), frame.strain.end()));
}

TEST(FillFrame, AFrameGoesFromTheSimulationToItsReaderWithoutAllocating) {
  cloth::Simulation simulation(cloth::builtin_scene("wind"));
  cloth::Vec3Field scratch;
  FrameExchange exchange;
  std::shared_ptr<const ClothFrame> shown;
  const auto round = [&] {
    const auto frame = exchange.blank();
    fill_frame(simulation, simulation.state(), scratch, *frame);
    exchange.publish(frame);
    if (auto newest = exchange.take()) shown = std::move(newest);
  };
  for (int warm_up = 0; warm_up < 4; ++warm_up) round();
  for (int i = 0; i < 10; ++i) {
    simulation.step();
    const test::Allocations made = test::allocations_of(round);
    EXPECT_EQ(made.calls, 0) << made.bytes << " bytes in round " << i;
  }
}

}  // namespace
}  // namespace clothlab::fill_frame_test
