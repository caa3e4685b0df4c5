// The yardstick: a mass-spring step as a textbook writes it. Particles are structs, springs are index pairs,
// one spring after the other in plain code, compiled for the baseline processor; semi-implicit Euler with
// gravity and viscous damping, nothing else. It keeps no ledger and looks for no divergence, so it does less
// than a step of Clothlab, and the ratio to it is a fair one.
#pragma once

#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth::speed {

class ReferenceKernel {
 public:
  /// Starts from `state`. Uses springs, gravity and viscous damping of `scene` and ignores the rest.
  ReferenceKernel(const Scene& scene, const ClothSystem& system, const ClothState& state);

  void step(double h);

  /// The largest distance in m between its particles and those of `position`.
  double distance_to(const Vec3Field& position) const;

 private:
  struct Particle {
    double x[3], v[3], f[3];
    double inverse_mass;
  };
  struct Spring {
    int i, j;
    double rest_length, stiffness;
  };

  std::vector<Particle> particles_;
  std::vector<Spring> springs_;
  double weight_[3];
  double damping_;
};

}  // namespace cloth::speed
