// What the worker hands to the view: one picture of the cloth, newest wins. Plain values, single precision,
// ready to upload.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace clothlab {

struct ClothFrame {
  std::uint64_t topology = 0;  ///< changes when rows, columns or a new start change the mesh
  int rows = 0, columns = 0;   ///< of a mesh 1 and the number of vertices
  std::shared_ptr<const cloth::SceneMesh> mesh;  ///< what a cloth from a mesh is made of; none: a grid
  std::vector<float> positions;                  ///< m; x y z of particle 0, of particle 1, ... (row-major)
  std::vector<float> normals;        ///< like positions; along the sum of the neighbouring triangles' areas
  std::vector<float> strain;         ///< per particle: largest |d|/L - 1 of its structural and shear springs
  float largest_strain = 0;          ///< of `strain`, at least 0
  bool shows_difference = false;     ///< `strain` holds distances from a reference, m, in place of strains
  std::vector<std::uint8_t> pinned;  ///< per particle: 1 where pinned
  std::vector<cloth::Obstacle> obstacles;
  double deformation_rate = -1;  ///< negative: the scene has none
  double time = 0;               ///< s
  std::int64_t step = 0;

  bool has_cloth() const { return mesh || (rows > 1 && columns > 1); }
};

}  // namespace clothlab
