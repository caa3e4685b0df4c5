// Materials as files of their own, NAME.material.json: those of resources/materials, compiled in as presets,
// and anybody's.
//
//     { "format": "clothlab/material/1", "title": "...",
//       "source": { "author": "...", "year": 2011, "measured": "...", "assumed": "..." },
//       "material": { "areal_density": 0.2, "stretch_warp": 500, ... } }
//
// "material" is the block of a scene; "bending_45" may stand for "twist".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloth/material.h"
#include "params/problem.h"
#include "scene/scene_mesh.h"

namespace cloth {

inline constexpr const char* material_format = "clothlab/material/1";

/// Where a material's numbers come from.
struct MaterialSource {
  std::string author{};    ///< empty: nobody measured it
  int year = 0;            ///< 0: not known
  std::string measured{};  ///< what was measured, and how
  std::string assumed{};   ///< what was not
  bool operator==(const MaterialSource&) const = default;

  std::string text() const;  ///< "Wang, O'Brien, Ramamoorthi 2011"
};

struct MaterialFile {
  std::string title;
  MaterialSource source;
  Material material;
  bool operator==(const MaterialFile&) const = default;
};

/// A material, or the problems because of which there is none: exactly one of the two.
struct MaterialFileReading {
  std::optional<MaterialFile> file;
  std::vector<Problem> problems;
};

/// `place` names the text in messages.
MaterialFileReading read_material_file(const std::string& text, const std::string& place);

/// Writes every value, with numbers that read back to the same bits.
std::string write_material_file(const MaterialFile& file);

/// JSON Schema (draft 7) of the file.
std::string material_schema();

struct BuiltinMaterial {
  std::string name;
  std::string title;
  std::string text;  ///< JSON
};

/// Those of resources/materials.
const std::vector<BuiltinMaterial>& builtin_materials();

/// nullptr if there is none of that name.
const BuiltinMaterial* find_builtin_material(const std::string& name);

/// A built-in material that must exist, parsed.
MaterialFile builtin_material(const std::string& name);

/// What a scene's "preset" names: one that is built in, or a file, seen from the scene's folder, where the
/// name has a "/" or ends in ".json". Or the rule that the name breaks.
struct PresetReading {
  std::optional<MaterialFile> file;
  std::string rule;
};
PresetReading read_preset(const std::string& name, const SceneFolder& folder);

}  // namespace cloth
