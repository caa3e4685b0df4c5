// The parameters of a scene, seen without knowing its structs: what forms, `--set`, sweeps and the reference
// page use. Declarations stand in scene_parameters.cpp, once each.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

template <class Owner>
using Fields = std::vector<Field<Owner>>;

/// The declarations themselves, for the JSON reader and writer and the schema.
const Fields<ClothSheet>& cloth_fields(bool is_mesh);
const Fields<SpringMaterial>& spring_fields();
const Fields<Gust>& gust_fields();
const Fields<Air>& air_fields();
const Fields<Deformation>& deformation_fields();
const Fields<Obstacle>& obstacle_fields(Shape shape);
const Fields<Obstacle>& motion_fields();  ///< of any obstacle; in a file only where it moves
const Fields<Keyframe>& keyframe_fields();
const Fields<ContactSettings>& contact_fields();
const Fields<SelfContact>& self_contact_fields();
const Fields<IntegratorChoice>& integrator_fields(const std::string& method);  ///< with its own settings
const Fields<Recording>& recording_fields();
const Fields<Scene>& scene_fields();  ///< title, damping, gravity, duration: the keys of the root

/// Of what comes from mesh files (mesh_declarations.cpp).
Fields<ClothSheet> mesh_cloth_fields();
Fields<Obstacle> mesh_obstacle_fields();

/// One parameter of a scene, bound to its dotted path ("obstacles.0.friction").
struct Parameter {
  std::string path;
  ParameterInfo info;
  std::function<ParameterValue(const Scene&)> get;  ///< the block must be present
  std::function<void(Scene&, const ParameterValue&)> set;
};

/// A group of parameters that belongs to one piece of physics. `path` is its identity: "cloth", "springs",
/// "damping", "gravity", "air", "air.gust", "deformation", "obstacles.N", "contact",
/// "self_contact", "integrator", "run".
struct Block {
  std::string path;
  std::string title;
  std::string doc;
  bool removable = false;
  std::vector<Parameter> parameters;
};

/// The blocks that this scene has, in the order of a form.
std::vector<Block> blocks_of(const Scene& scene);

/// Every parameter that this scene has.
std::vector<Parameter> parameters_of(const Scene& scene);

/// The parameter at `path`, if this scene has it.
std::optional<Parameter> find_parameter(const Scene& scene, const std::string& path);

/// What an Add menu offers for this scene: blocks it does not have, and obstacles. `add` fills in sensible
/// values.
struct BlockOffer {
  std::string path;  ///< of the block it would add; for obstacles the shape's name
  std::string title;
  std::string doc;
  std::function<void(Scene&)> add;
};
std::vector<BlockOffer> offers_for(const Scene& scene);

/// Takes a removable block out. Unknown or absent paths leave the scene as it is.
void remove_block(Scene& scene, const std::string& path);

/// What an absent value means in the file: the default of the declaration, for resets and tooltips.
std::optional<ParameterValue> default_of(const Scene& scene, const std::string& path);

}  // namespace cloth
