// Sheets that hang from pins with a deformation rate, and what the tensions of their springs have to be.
#pragma once

#include <gtest/gtest.h>

#include "cloth/grid.h"
#include "limiter/tension_solver.h"
#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test {

struct Hung {
  Scene scene;
  ClothSystem system;
  Deformation deformation;

  Hung(int side, double rate, std::vector<Pin> pins = {NamedPin::top_left, NamedPin::top_right})
      : scene(bare_sheet(side, side, 1.0 / (side - 1))) {
    scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
    scene.cloth.pins = std::move(pins);
    system = make_grid(scene.cloth, *scene.springs);
    deformation.rate = rate;
  }
  double spacing() const { return 1.0 / (scene.cloth.columns - 1); }
};

inline SpringTensions no_tension(const TensionSolver& solver) {
  return SpringTensions(solver.springs().size());
}

inline double length_of(const TensionSpring& spring, const Vec3Field& x) {
  return (x[spring.second] - x[spring.first]).norm();
}

/// Stretched in its plane by `strain` and moved about at random by `noise`, except where it is pinned.
inline Vec3Field stretched(const ClothSystem& system, double strain, double noise, Random& random) {
  Vec3Field x = system.start;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!system.pinned[i]) x.set(i, (1 + strain) * x[i] + random.vector(noise));
  return x;
}

/// What a solution is, to the tolerance: the rate kept, tensions that pull, and none where there is slack.
inline void expect_solution(const TensionSolver& solver, double tolerance, const SpringTensions& tension,
                            const Vec3Field& x) {
  for (std::size_t s = 0; s < solver.springs().size(); ++s) {
    const TensionSpring& spring = solver.springs()[s];
    const double over = (length_of(spring, x) - spring.limit) / spring.rest_length;
    ASSERT_LE(over, 1.000001 * tolerance) << s;
    ASSERT_GE(tension[s], 0) << s;
    if (tension[s] > 0) {
      ASSERT_GE(over, -1.000001 * tolerance) << s;
    }
  }
}

}  // namespace cloth::test
