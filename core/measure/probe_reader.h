// Reads a scene's probes off a state. It only looks on.
//
//     const ProbeReader probes(scene, system);
//     probes.columns();              // "probe.tip.x_m", ...
//     probes.read(system, state);    // one number for each column
#pragma once

#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"

namespace cloth {

class ProbeReader {
 public:
  ProbeReader() = default;  ///< of no probes
  /// Precondition: find_probe_problems(scene) is empty and `system` is made of the scene.
  ProbeReader(const Scene& scene, const ClothSystem& system);

  /// A probe with its particles' numbers in the cloth.
  struct Probed {
    Probe probe;
    std::vector<int> particles;
    double start_length = 0;  ///< m, of what a distance or a line measures, at the start
  };
  const std::vector<Probed>& probes() const { return probes_; }
  const std::vector<std::string>& columns() const { return columns_; }

  /// In the order of the columns, in SI units; not a number where a value is not defined in this state.
  std::vector<double> read(const ClothSystem& system, const ClothState& state) const;

 private:
  std::vector<Probed> probes_;
  std::vector<std::string> columns_;
  std::vector<Triangle> triangles_;  ///< of the cloth, where a probe asks for its shadow
  Vec3 up_{0, 1, 0}, gravity_{0, 0, 0};
  Vec3 middle_{0, 0, 0};  ///< m, of the box around the start
};

}  // namespace cloth
