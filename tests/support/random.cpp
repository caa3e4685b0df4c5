#include "support/random.h"

#include <cstdio>
#include <cstdlib>

namespace cloth::test {
namespace {

unsigned long seed() {
  constexpr unsigned long fixed = 19950517;
  const char* given = std::getenv("CLOTHLAB_TEST_SEED");
  return given ? std::strtoul(given, nullptr, 10) : fixed;
}

}  // namespace

Random::Random() : engine_(seed()) {
  std::printf("random seed %lu (CLOTHLAB_TEST_SEED)\n", seed());
}

double Random::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine_);
}

double Random::normal(double deviation) {
  return std::normal_distribution<double>(0, deviation)(engine_);
}

int Random::integer(int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(engine_);
}

Vec3 Random::vector(double deviation) {
  const double x = normal(deviation), y = normal(deviation), z = normal(deviation);
  return {x, y, z};
}

Vec3Field Random::field(std::size_t size, double deviation) {
  Vec3Field field(size);
  for (std::size_t i = 0; i < size; ++i) field.set(i, vector(deviation));
  return field;
}

}  // namespace cloth::test
