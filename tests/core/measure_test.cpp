#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/sums.h"
#include "measure/energy.h"
#include "measure/strain.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::measure_test {
namespace {

/// 2x2, particles of 10 g, spacing 0.1; particle 3 moved to the length 0.15 of its two structural springs...
struct Sample {
  Sample() {
    scene = bare_sheet(2, 2, 0.1, 0.01);
    scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 0, .damping = 0};
    system = make_grid(scene.cloth, *scene.springs);
    state = starting_state(system);
    state.position.set(1, {0.15, 0, 0});
    state.position.set(3, {0.15, -0.1, 0});  // both rows are 50 % longer
  }
  Scene scene;
  ClothSystem system;
  ClothState state;
};

TEST(Energy, KineticIsHalfTheMassTimesTheSquaredSpeeds) {
  Sample s;
  s.state.velocity.set(0, {1, 2, 2});
  s.state.velocity.set(2, {0, 0, 4});
  EXPECT_NEAR(measure_energy(s.system, Vec3::Zero(), s.state).kinetic, 0.5 * 0.01 * (9 + 16), 1e-16);
}

TEST(Energy, ElasticIsTheSumOverTheSpringsOfEachFamily) {
  const Sample s;
  const Energy energy = measure_energy(s.system, Vec3::Zero(), s.state);
  const double structural = 2 * 0.5 * 100 * 0.05 * 0.05;
  const double stretch = std::hypot(0.15, 0.1) - 0.1 * std::sqrt(2.0);
  const double shear = 2 * 0.5 * 50 * stretch * stretch;
  EXPECT_NEAR(energy.elastic_by_family[0], structural, 1e-15);
  EXPECT_NEAR(energy.elastic_by_family[1], shear, 1e-15);
  EXPECT_EQ(energy.elastic_by_family[2], 0);
  EXPECT_NEAR(energy.elastic, structural + shear, 1e-15);
}

TEST(Energy, OfGravityIsTheWeightTimesTheRise) {
  Sample s;
  s.state.position = s.system.start;
  s.state.position.add(2, {5, 0.3, 5});
  EXPECT_NEAR(measure_energy(s.system, {0, -9.81, 0}, s.state).gravity, 0.01 * 9.81 * 0.3, 1e-15);
  EXPECT_NEAR(measure_energy(s.system, {1, 0, 0}, s.state).gravity, -0.01 * 5, 1e-15);
  EXPECT_EQ(measure_energy(s.system, Vec3::Zero(), s.state).gravity, 0);
}

TEST(Strain, IsTheElongationOverTheRestLengthPerFamily) {
  const Sample s;
  const Strain strain = measure_strain(s.system, s.state.position);
  EXPECT_NEAR(strain.largest[0], 0.5, 1e-14);
  EXPECT_NEAR(strain.largest[1], std::hypot(0.15, 0.1) / (0.1 * std::sqrt(2.0)) - 1, 1e-14);
  EXPECT_EQ(strain.largest[2], 0);
  EXPECT_NEAR(strain.maximum(), 0.5, 1e-14);
}

TEST(Strain, DoesNotCountFlexionInItsMaximum) {
  Scene scene = bare_sheet(3, 3);
  const ClothSystem system = make_grid(scene.cloth, only(SpringFamily::flexion, 1));
  Vec3Field position = system.start;
  for (std::size_t right = 2; right < 9; right += 3) position.add(right, {0.1, 0, 0});
  EXPECT_NEAR(measure_strain(system, position).largest[2], 0.5, 1e-12);
  EXPECT_EQ(measure_strain(system, position).maximum(), 0);
}

TEST(Strain, OfCompressedSpringsIsNegative) {
  Sample s;
  for (const std::size_t right : {1u, 3u}) s.state.position.set(right, {0.05, s.system.start[right].y(), 0});
  for (const std::size_t low : {2u, 3u}) s.state.position.add(low, {0, 0.05, 0});
  EXPECT_NEAR(measure_strain(s.system, s.state.position).largest[0], -0.5, 1e-14);
}

TEST(ParticleStrain, IsTheLargestOfTheParticlesSprings) {
  const Sample s;
  std::array<float, 4> strain{};
  particle_strain(s.system, s.state.position, strain);
  for (const float value : strain) EXPECT_NEAR(value, 0.5f, 1e-6f);

  Scene scene = bare_sheet(2, 3);
  const ClothSystem system = make_grid(scene.cloth, only(SpringFamily::structural, 1));
  Vec3Field position = system.start;
  for (const std::size_t right : {2u, 5u}) position.add(right, {0.02, 0, 0});
  std::array<float, 6> each{};
  particle_strain(system, position, each);
  EXPECT_NEAR(each[0], 0, 1e-6);
  EXPECT_NEAR(each[1], 0.2, 1e-6);
  EXPECT_NEAR(each[2], 0.2, 1e-6);
}

TEST(ParticleStrain, IsZeroForAParticleWithoutSprings) {
  const ClothSystem system = make_grid(bare_sheet(2, 2).cloth, {});
  std::array<float, 4> strain{9, 9, 9, 9};
  particle_strain(system, system.start, strain);
  for (const float value : strain) EXPECT_EQ(value, 0);
}

TEST(OrderedSum, AddsEveryTermOnce) {
  for (std::size_t count = 0; count < 40; ++count)
    EXPECT_EQ(ordered_sum(count, [](std::size_t k) { return static_cast<double>(k + 1); }),
              static_cast<double>(count * (count + 1) / 2));
}

}  // namespace
}  // namespace cloth::test::measure_test
