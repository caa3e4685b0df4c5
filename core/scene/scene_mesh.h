// The triangle meshes that a scene names by their files: obstacles of any shape, and cloths of any outline.
//
//     Scene scene = ...;                              // scene.cloth.mesh.file = "disc.obj"
//     std::vector<Problem> problems = load_meshes(scene);
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "params/problem.h"

namespace cloth {

struct Scene;
struct Obstacle;

/// A mesh as it came from its file, each vertex once; what is constant however it is placed.
struct SceneMesh {
  std::string file;  ///< as the scene named it
  bool built_in = false;
  TriangleMesh surface;                    ///< m
  std::vector<std::array<int, 2>> edges;   ///< each once, lower vertex first, ascending
  std::vector<std::array<int, 2>> hinges;  ///< the vertices opposite an edge of two triangles, likewise
  Eigen::AlignedBox3d bounds;              ///< m, of the vertices
  std::string hash;                        ///< of vertices and triangles, 16 hexadecimal digits
  std::size_t open_edges = 0;              ///< of one triangle only: a border
  std::vector<std::string> notices;        ///< what else is unusual about it, a sentence each
};

/// The mesh that a scene chose: a file, and what was in it when it was read. Two are the same if both are.
struct MeshChoice {
  std::string file;                         ///< relative to the scene's folder, or a built-in mesh; "": none
  std::shared_ptr<const SceneMesh> loaded;  ///< of `file`, once load_meshes() has been there

  bool is_loaded() const { return loaded && loaded->file == file; }
  bool operator==(const MeshChoice& other) const;
};

/// Where the files lie that a scene names. It is where values come from, none itself: two scenes are equal
/// whatever folders they came from.
struct SceneFolder {
  std::string path;       ///< "": the current folder
  bool built_in = false;  ///< a built-in scene: built-in meshes go before files
  bool operator==(const SceneFolder&) const { return true; }
};

/// Reads every mesh that the scene names and has not read yet. `known` may have some of them already. What
/// cannot be used is a problem.
std::vector<Problem> load_meshes(Scene& scene, const Scene* known = nullptr);

/// What is unusual about the scene's meshes (a cloth may have a border), a sentence each: `obstacles.0.file =
/// "bunny.obj": ...`
std::vector<std::string> mesh_notices(const Scene& scene);

/// The files that the scene's meshes were read from; built-in ones have none.
std::vector<std::string> mesh_files(const Scene& scene);

/// The same scene for a file in another folder: files are named as seen from there.
Scene moved_to_folder(const Scene& scene, const std::string& folder);

/// The obstacle's surface in the world, m: scaled, turned about x, y and z in turn, moved. Precondition: it
/// is loaded.
TriangleMesh placed_mesh(const Obstacle& obstacle);

/// The turn alone, R_z R_y R_x.
Eigen::Matrix3d turn_of(const Obstacle& obstacle);

/// A box in the world that holds the placed mesh; empty if it is not loaded.
Eigen::AlignedBox3d placed_bounds(const Obstacle& obstacle);

}  // namespace cloth
