// What the hierarchy of boxes costs: a mesh of 70,312 triangles asked by the 50,176 particles of a cloth near
// it, and the cloth's edges against each other. Milliseconds of the thread's own processor time, the least of
// several runs.
//
//     clothlab-box-tree-bench [RUNS]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "geometry/box_tree.h"

namespace {

using cloth::Bounds;
using cloth::bounds_of;
using cloth::Vec3;

double processor_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Work>
double milliseconds(int runs, Work&& work) {
  double least = HUGE_VAL;
  for (int run = 0; run < runs; ++run) {
    const double start = processor_seconds();
    work();
    least = std::min(least, processor_seconds() - start);
  }
  return 1e3 * least;
}

/// A ball of 0.3 m with bumps: 188 rings of 187 pairs of triangles.
std::vector<Bounds> bumpy_ball() {
  constexpr int rings = 188, around = 187;
  const auto at = [](int i, int j) {
    const double theta = M_PI * (i + 0.5) / (rings + 1), phi = 2 * M_PI * j / around;
    const double radius = 0.3 * (1 + 0.2 * std::sin(9 * theta) * std::cos(7 * phi));
    return Vec3(radius * std::sin(theta) * std::cos(phi), radius * std::cos(theta),
                radius * std::sin(theta) * std::sin(phi));
  };
  std::vector<Bounds> boxes;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      boxes.push_back(bounds_of(at(i, j), at(i + 1, j), at(i, j + 1)));
      boxes.push_back(bounds_of(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  return boxes;
}

constexpr int side = 224;  // particles along the cloth

/// 1 m of cloth laid over the ball.
std::vector<Vec3> draped_cloth() {
  std::vector<Vec3> particles;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double x = i / (side - 1.0) - 0.5, z = j / (side - 1.0) - 0.5, out = std::hypot(x, z);
      const double y = out < 0.29 ? std::sqrt(0.31 * 0.31 - out * out) : 0.11 - 0.8 * (out - 0.29);
      const double fold = 0.3 * (1 - 0.29 / out) * (1 + std::sin(16 * std::atan2(z, x)));
      const double scale = out < 0.29 ? 1 : 0.29 / out + fold;
      particles.emplace_back(scale * x, y, scale * z);
    }
  }
  return particles;
}

std::vector<Bounds> edge_boxes(const std::vector<Vec3>& particles, double margin) {
  std::vector<Bounds> boxes;
  const auto add = [&](int i, int j) {
    boxes.push_back(bounds_of(particles[static_cast<std::size_t>(i)], particles[static_cast<std::size_t>(j)])
                        .grown(margin));
  };
  for (int i = 0; i < side * side; ++i) {
    const bool right = i % side + 1 < side, below = i + side < side * side;
    if (right) add(i, i + 1);
    if (below) add(i, i + side);
    if (right && below) add(i + 1, i + side);
  }
  return boxes;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const std::vector<Bounds> triangles = bumpy_ball();
  const std::vector<Vec3> particles = draped_cloth();
  std::vector<Bounds> queries;
  for (const Vec3& particle : particles) queries.push_back(bounds_of(particle).grown(0.005));

  cloth::BoxTree tree;
  std::vector<cloth::BoxPair> pairs;
  fmt::print("{} triangles: build {:.1f} ms", triangles.size(),
             milliseconds(runs, [&] { tree = cloth::BoxTree(triangles); }));
  fmt::print(", refit {:.2f} ms\n", milliseconds(runs, [&] { tree.refit(triangles); }));
  const double asked = milliseconds(runs, [&] { pairs.clear(), tree.collect(queries, pairs); });
  const double count = static_cast<double>(queries.size());
  fmt::print("{} particles: {:.2f} ms, {:.0f} ns and {:.2f} pairs each\n", queries.size(), asked,
             1e6 * asked / count, static_cast<double>(pairs.size()) / count);

  for (const double margin : {0.0005, 0.002}) {
    const std::vector<Bounds> edges = edge_boxes(particles, margin);
    fmt::print("{} edges, margin {:.1f} mm: build {:.1f} ms", edges.size(), 1e3 * margin,
               milliseconds(runs, [&] { tree = cloth::BoxTree(edges); }));
    fmt::print(", refit {:.2f} ms", milliseconds(runs, [&] { tree.refit(edges); }));
    const double own = milliseconds(runs, [&] { pairs.clear(), tree.collect_own(pairs); });
    fmt::print(", own pairs {:.1f} ms, {:.2f} pairs each\n", own,
               static_cast<double>(pairs.size()) / static_cast<double>(edges.size()));
  }
}
