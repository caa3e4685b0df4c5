// Access to the parameters of a scene by path, without its structs: for forms, `--set`, sweeps and the
// reference page. Each parameter is declared once, in *_declarations.cpp or in a file of scene/shapes/.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

/// Declarations that depend on a choice; those of the other blocks stand in their rows (scene/blocks.h).
const Fields<ClothSheet>& cloth_fields(bool is_mesh);
const Fields<Obstacle>& obstacle_fields(Shape shape);
const Fields<Obstacle>& motion_fields();  ///< of any obstacle; in a file only where it moves
const Fields<Keyframe>& keyframe_fields();
const Fields<IntegratorChoice>& integrator_fields(const std::string& method);  ///< with its own settings

/// One parameter of a scene, bound to its dotted path ("obstacles.0.friction").
/// `get` and `set` need its block to be present, but `set` of a block that is one value, "gravity", adds it.
struct Parameter : Field<Scene> {
  std::string path;
};

/// Of a cloth that is a grid or a mesh.
std::vector<Parameter> cloth_parameters(bool is_mesh);

/// A group of parameters that belongs to one piece of physics. `path` is its identity: "cloth", "springs",
/// "material", "damping", "gravity", "air", "air.gust", "deformation", "obstacles.N", "contact",
/// "self_contact", "integrator", "probes.N", "run".
struct Block {
  std::string path;
  std::string title;
  std::string doc;
  bool removable = false;
  std::vector<Parameter> parameters;
};

/// The blocks that this scene has, in the order of a form.
std::vector<Block> blocks_of(const Scene& scene);

/// Gives the scene every optional block, obstacles and probes aside, with the values that the Add menu fills
/// in.
void add_every_block(Scene& scene);

/// Every parameter that this scene has.
std::vector<Parameter> parameters_of(const Scene& scene);

/// The parameter at `path`, if this scene has it.
std::optional<Parameter> find_parameter(const Scene& scene, const std::string& path);

/// What an Add menu offers for this scene: blocks it does not have, obstacles, and probes of the whole shape.
/// `add` fills in sensible values.
struct BlockOffer {
  enum class Group { block, obstacle, probe };
  std::string path;  ///< of the block it would add; for obstacles the shape's name, for probes the measure's
  std::string title;
  std::string doc;
  std::function<void(Scene&)> add;
  Group group = Group::block;
};
std::vector<BlockOffer> offers_for(const Scene& scene);

/// Takes a removable block out. Unknown or absent paths leave the scene as it is.
void remove_block(Scene& scene, const std::string& path);

/// docs/parameters.md, as Markdown: the reference of all parameters, made from their declarations.
std::string reference_page();

/// What an absent value means in the file: the default of the declaration, for resets and tooltips.
std::optional<ParameterValue> default_of(const Scene& scene, const std::string& path);

}  // namespace cloth
