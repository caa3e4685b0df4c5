// The triangle meshes that a scene names by their files: obstacles of any shape, and cloths of any outline.
//
//     Scene scene = ...;                              // scene.cloth.mesh.file = "disc.obj"
//     std::vector<Problem> problems = load_meshes(scene);
#pragma once

#include <string>
#include <vector>

#include "geometry/loaded_mesh.h"
#include "params/parameter.h"
#include "params/problem.h"

namespace cloth {

struct Scene;

/// A mesh is chosen by its file; load_meshes() reads it.
template <class Owner>
Field<Owner> field(MeshChoice Owner::*member, ParameterInfo info) {
  info.kind = Kind::text;
  return {std::move(info), [member](const Owner& owner) { return ParameterValue((owner.*member).file); },
          [member](Owner& owner, const ParameterValue& value) {
            (owner.*member).file = std::get<std::string>(value);
          }};
}

/// The folder of the files that a scene names, measured points too. It is not a value of the scene: scenes
/// from different folders can be equal.
struct SceneFolder {
  std::string path;       ///< "": the current folder
  bool built_in = false;  ///< a built-in scene: built-in meshes go before files
  bool operator==(const SceneFolder&) const { return true; }
};

/// Reads every mesh that the scene names and that is not loaded yet, or takes it from `known` where that has
/// it. Returns a problem for each mesh that cannot be used.
std::vector<Problem> load_meshes(Scene& scene, const Scene* known = nullptr);

/// A mesh made in memory, as if it had been read from a file of this name.
MeshChoice made_mesh(const std::string& name, const TriangleMesh& surface);

/// Warnings about the scene's meshes, a sentence each (a border is unusual only for obstacles):
/// `obstacles.0.file = "bunny.obj": ...`
std::vector<std::string> mesh_notices(const Scene& scene);

/// The files that the scene's meshes were read from; built-in ones have none.
std::vector<std::string> mesh_files(const Scene& scene);

/// The same scene for a file in another folder: files are named as seen from there.
Scene moved_to_folder(const Scene& scene, const std::string& folder);

}  // namespace cloth
