// What the worker hands to the view: one picture of the cloth, newest wins. Plain values, single precision,
// ready to upload.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/obstacle_motion.h"
#include "scene/scene.h"

namespace clothlab {

/// What of contact a view wants to be told; nothing costs nothing.
struct ContactChoice {
  bool marks = false;  ///< where the cloth touches something
  int box_level = -1;  ///< boxes of the hierarchies so far below their roots; negative: none
  bool operator==(const ContactChoice&) const = default;
};

/// Contact as it is drawn.
struct ContactPicture {
  struct Boxes {
    int obstacle =
        -1;  ///< in whose coordinates they are, as the scene has it; -1: the cloth's, in the world's
    int count = 0;
  };
  bool has_marks = false;
  std::vector<float>
      marks;  ///< 7 for each touch: point in m, normal, and its push as a share of the strongest
  std::vector<float> boxes;   ///< 6 for each box: its lower and its upper corner, m
  std::vector<Boxes> groups;  ///< that `boxes` consists of, in order
  int depth = 0;              ///< levels of the deepest hierarchy of the scene, shown or not; 0: it has none
};

struct ClothFrame {
  std::uint64_t topology = 0;  ///< changes when rows, columns or a new start change the mesh
  int rows = 0, columns = 0;   ///< of a mesh 1 and the number of vertices
  std::shared_ptr<const cloth::LoadedMesh> mesh;  ///< what a cloth from a mesh is made of; none: a grid
  std::vector<float> positions;                   ///< m; x y z of particle 0, of particle 1, ... (row-major)
  std::vector<float> normals;        ///< like positions; along the sum of the neighbouring triangles' areas
  std::vector<float> strain;         ///< per particle: largest |d|/L - 1 of its structural and shear springs
  float largest_strain = 0;          ///< of `strain`, at least 0
  bool shows_difference = false;     ///< `strain` holds distances from a reference, m, in place of strains
  std::vector<std::uint8_t> pinned;  ///< per particle: 1 where pinned
  std::vector<cloth::Obstacle> obstacles;
  std::vector<cloth::Pose> poses;    ///< of the obstacles now; none: all are where the scene has them
  std::vector<cloth::Pose> targets;  ///< and where they would be, were an edit's move not still under way
  ContactPicture contact;
  double deformation_rate = -1;  ///< negative: the scene has none
  double time = 0;               ///< s
  std::int64_t step = 0;

  bool has_cloth() const { return mesh || (rows > 1 && columns > 1); }
  cloth::Pose pose(std::size_t obstacle) const { return poses.empty() ? cloth::Pose{} : poses[obstacle]; }
  cloth::Pose target(std::size_t obstacle) const {
    return targets.empty() ? cloth::Pose{} : targets[obstacle];
  }
};

}  // namespace clothlab
