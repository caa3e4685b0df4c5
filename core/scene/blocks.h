// The table of a scene's blocks, one row each (block_declarations.cpp). The reader and the writer of scene
// files, the JSON Schema, forms, the Add menu, removal and default values use it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/scene_parameters.h"

namespace cloth {

/// How an optional block is added to a scene and removed.
struct OptionalBlock {
  std::function<void(Scene&)> add;     ///< with the values that a file's empty block has
  std::function<void(Scene&)> start;   ///< with the values that the Add menu fills in
  std::function<void(Scene&)> remove;  ///< leaves a scene without it as it is
  /// Whether the Add menu offers it to a scene that does not have it.
  std::function<bool(const Scene&)> suits;
};

struct BlockRow {
  std::string path;  ///< identifies the block; prefix of its parameters' paths, except for "run" and "title"
  int file_place = 0;      ///< ascending order in a file; the order of the table is that of forms
  std::string title{};     ///< of its section in a form; empty: no section
  std::string doc{};       ///< one sentence
  std::string mesh_doc{};  ///< in place of `doc` where the cloth is a mesh
  /// The parameters for scenes of this kind (grid or mesh, method); the scene need not have the block. Empty
  /// for "obstacles" and "probes", which are lists.
  std::function<std::vector<Parameter>(const Scene&)> parameters{};
  std::function<bool(const Scene&)> is_present{};
  std::optional<OptionalBlock> optional{};  ///< none: every scene has it
};

/// In the order of a form.
const std::vector<BlockRow>& block_rows();

/// In the order of a file.
const std::vector<const BlockRow*>& block_rows_of_file();

/// One stage of a step, for the command `explain`.
struct StageInfo {
  std::string name;
  bool present = false;
  std::string reason;  ///< what it does here, or why it is not needed
};

/// The text of `explain` for a stage whose block the scene does not have; none where it has the block.
std::optional<StageInfo> absent_stage(const std::string& stage, const Scene& scene, const std::string& block);

/// The path of the JSON object that contains a parameter or block: "springs" for "springs.shear", "" for
/// "damping".
std::string parent_path(const std::string& path);

/// Turns fields of an Owner (such as Air) into parameters of a scene: `owner_of` returns the scene's Owner,
/// and `prefix` is the path before the fields' keys.
template <class Owner, class OwnerOf>
std::vector<Parameter> bound(const std::string& prefix, const Fields<Owner>& fields, OwnerOf owner_of) {
  std::vector<Parameter> parameters;
  for (const Field<Owner>& field : fields)
    parameters.push_back({{field.info,
                           [get = field.get, owner_of](const Scene& scene) {
                             return get(owner_of(const_cast<Scene&>(scene)));
                           },
                           [set = field.set, owner_of](Scene& scene, const ParameterValue& value) {
                             set(owner_of(scene), value);
                           }},
                          joined_path(prefix, field.info.key)});
  return parameters;
}

}  // namespace cloth
