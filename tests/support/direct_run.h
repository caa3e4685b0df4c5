// A force model and an integrator without the loop around them: for laws of the method alone, from any state.
#pragma once

#include <memory>
#include <string>

#include "integrators/integrator.h"

namespace cloth::test {

class DirectRun {
 public:
  DirectRun(const Scene& scene, const IntegratorChoice& choice);
  DirectRun(const Scene& scene, const std::string& method) : DirectRun(scene, IntegratorChoice{method}) {}
  DirectRun(const DirectRun&) = delete;
  DirectRun& operator=(const DirectRun&) = delete;

  /// `steps` steps of length `step`; time goes on as n * step.
  void advance(int steps, double step);

  /// The acceleration of every particle at the present state, in m/s^2; zero on pins.
  Vec3Field acceleration();

  Integrator& integrator() { return *integrator_; }

  ClothSystem system;
  ClothState state;
  ForceModel forces;
  Work work;
  int force_evaluations = 0;

 private:
  std::unique_ptr<Integrator> integrator_;
};

}  // namespace cloth::test
