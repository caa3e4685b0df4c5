// The data of one picture of the cloth, which the worker hands to the view; the newest frame replaces older
// ones. Plain values in single precision, laid out for OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "measure/probe_reader.h"
#include "scene/obstacle_motion.h"
#include "scene/scene.h"

namespace clothlab {

/// Which contact data the frames contain. The default asks for none, and none is then computed.
struct ContactChoice {
  bool marks = false;  ///< the places where the cloth touches an obstacle or itself
  int box_level = -1;  ///< depth below the root at which boxes of the bounding volume hierarchies are shown;
                       ///< negative: none
  bool operator==(const ContactChoice&) const = default;
};

/// Contact as it is drawn.
struct ContactPicture {
  struct Boxes {
    int obstacle = -1;  ///< index of the obstacle in whose body coordinates the boxes are; -1: the cloth's
                        ///< boxes, in world coordinates
    int count = 0;
  };
  bool has_marks = false;
  std::vector<float>
      marks;  ///< 7 for each touch: point (m), normal, and its normal impulse divided by the largest one
  std::vector<float> boxes;   ///< 6 for each box: lower and upper corner (m)
  std::vector<Boxes> groups;  ///< the groups that `boxes` consists of, in order
  int depth = 0;  ///< levels of the deepest hierarchy of the scene, shown or not; 0: the scene has none
};

struct ClothFrame {
  std::uint64_t topology =
      0;  ///< a number that changes with every new start and every change of rows, columns or mesh
  int rows = 0, columns = 0;                      ///< for a mesh cloth 1 and the number of vertices
  std::shared_ptr<const cloth::LoadedMesh> mesh;  ///< the mesh of a mesh cloth; null: a grid cloth
  std::vector<float> positions;                   ///< m; x y z of particle 0, of particle 1, ... (row-major)
  std::vector<float>
      normals;  ///< unit vectors in the order of positions; area-weighted mean of the neighbouring triangles
  std::vector<float> strain;         ///< per particle: largest |d|/L - 1 of its structural and shear springs
  float largest_strain = 0;          ///< of `strain`, at least 0
  bool shows_difference = false;     ///< `strain` holds distances from a reference, m, in place of strains
  std::vector<std::uint8_t> pinned;  ///< per particle: 1 where pinned
  std::vector<cloth::Obstacle> obstacles;
  std::vector<cloth::Pose> poses;  ///< present poses of the obstacles; empty: all have the scene's poses
  std::vector<cloth::Pose>
      targets;  ///< the poses that the obstacles reach when the transition after an edit ends
  ContactPicture contact;
  std::vector<cloth::ProbeReader::Probed> probes;  ///< of the scene
  std::vector<double> probe_values;  ///< of all probes in order, SI units; not a number: not defined
  double deformation_rate = -1;      ///< pure number; negative: the scene has no limiter
  double time = 0;                   ///< s
  std::int64_t step = 0;

  bool has_cloth() const { return mesh || (rows > 1 && columns > 1); }
  cloth::Pose pose(std::size_t obstacle) const { return poses.empty() ? cloth::Pose{} : poses[obstacle]; }
  cloth::Pose target(std::size_t obstacle) const {
    return targets.empty() ? cloth::Pose{} : targets[obstacle];
  }
};

}  // namespace clothlab
