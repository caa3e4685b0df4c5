#include "scene/scene_parameters.h"

#include <algorithm>
#include <charconv>

namespace cloth {
namespace {

/// Binds the fields of an Owner that `owner_of` finds in a scene.
template <class Owner, class OwnerOf>
std::vector<Parameter> bound(const std::string& prefix, const Fields<Owner>& fields, OwnerOf owner_of) {
  std::vector<Parameter> parameters;
  for (const Field<Owner>& field : fields)
    parameters.push_back(
        {joined_path(prefix, field.info.key), field.info,
         [&field, owner_of](const Scene& scene) { return field.get(owner_of(const_cast<Scene&>(scene))); },
         [&field, owner_of](Scene& scene, const ParameterValue& value) {
           field.set(owner_of(scene), value);
         }});
  return parameters;
}

std::vector<Parameter> root_parameters(std::initializer_list<const char*> keys) {
  std::vector<Parameter> chosen;
  for (Parameter& parameter : bound<Scene>("", scene_fields(), [](Scene& s) -> Scene& { return s; }))
    if (std::find(keys.begin(), keys.end(), parameter.path) != keys.end())
      chosen.push_back(std::move(parameter));
  return chosen;
}

Block obstacle_block(const Scene& scene, std::size_t index) {
  const Shape shape = scene.obstacles[index].shape;
  const std::string path = "obstacles." + std::to_string(index);
  const auto same_before =
      std::count_if(scene.obstacles.begin(), scene.obstacles.begin() + static_cast<long>(index),
                    [&](const Obstacle& other) { return other.shape == shape; });
  std::string title = name_of(shape);
  title.front() = static_cast<char>(std::toupper(title.front()));
  const auto of_scene = [index](Scene& s) -> Obstacle& { return s.obstacles.at(index); };
  std::vector<Parameter> parameters = bound<Obstacle>(path, obstacle_fields(shape), of_scene);
  for (Parameter& parameter : bound<Obstacle>(path, motion_fields(), of_scene))
    parameters.push_back(std::move(parameter));
  return {path, title + " " + std::to_string(same_before + 1),
          "An obstacle that the cloth's particles cannot enter.", true, std::move(parameters)};
}

void add_contact_blocks(const Scene& scene, std::vector<Block>& blocks) {
  if (scene.contact)
    blocks.push_back(
        {"contact", "Contact", "Contact without gaps: no vertex, edge or face comes through.", true,
         bound<ContactSettings>("contact", contact_fields(),
                                [](Scene& s) -> ContactSettings& { return s.contact.value(); })});
  if (scene.self_contact)
    blocks.push_back({"self_contact", "Self-contact", "The cloth does not pass through itself.", true,
                      bound<SelfContact>("self_contact", self_contact_fields(),
                                         [](Scene& s) -> SelfContact& { return s.self_contact.value(); })});
}

Block run_block() {
  std::vector<Parameter> parameters = root_parameters({"duration"});
  for (Parameter& parameter :
       bound<Recording>("record", recording_fields(), [](Scene& s) -> Recording& { return s.record; }))
    parameters.push_back(std::move(parameter));
  return {"run", "Run and record", "How long a run is and how often it is recorded.", false,
          std::move(parameters)};
}

/// Of a cloth from a mesh that is loaded, as its file has it.
Eigen::AlignedBox3d bounds_of(const ClothSheet& cloth) {
  return cloth.mesh.is_loaded() ? cloth.mesh.loaded->bounds : Eigen::AlignedBox3d(Vec3(Vec3::Zero()));
}

constexpr const char* starter_mesh = "bunny.obj";

/// The height at which a new obstacle meets the cloth: below its lower edge if it hangs, under its middle if
/// it lies.
Vec3 middle_of(const ClothSheet& cloth) {
  if (cloth.is_mesh()) return cloth.origin + bounds_of(cloth).center();
  return cloth.origin + 0.5 * cloth.width * cloth.across.normalized() +
         0.5 * cloth.height * cloth.down.normalized();
}

Obstacle starter_obstacle(Shape shape, const ClothSheet& cloth) {
  Obstacle obstacle;
  obstacle.shape = shape;
  const double span =
      cloth.is_mesh() ? bounds_of(cloth).sizes().maxCoeff() : std::max(cloth.width, cloth.height);
  obstacle.radius = 0.25 * span;
  obstacle.size = Vec3::Constant(0.4 * span);
  obstacle.center = middle_of(cloth) - Vec3(0, 0.75 * span, 0);
  obstacle.point = middle_of(cloth) - Vec3(0, 1.25 * span, 0);
  if (shape == Shape::mesh) {
    obstacle.mesh.file = starter_mesh;
    obstacle.scale = 0.5 * span;
    obstacle.translate = middle_of(cloth) - Vec3(0, span, 0);
  }
  return obstacle;
}

/// As thick as the default says, or as the cells allow.
SelfContact starter_self_contact(const ClothSheet& cloth) {
  const double cell = std::min(cloth.width / (cloth.columns - 1), cloth.height / (cloth.rows - 1));
  SelfContact self_contact;
  self_contact.thickness = std::min(self_contact.thickness, 0.4 * cell);
  return self_contact;
}

const SpringMaterial starter_springs{.structural = 500, .shear = 250, .flexion = 50, .damping = 0};
constexpr double starter_damping = 0.001;
const Vec3 starter_gravity{0, -9.81, 0};
const Air starter_air{.drag = 0.01, .wind = {0, 0, 3}, .gust = std::nullopt};

/// A scene in which every optional block has its starting values: what "default" means.
Scene starter_scene(const Scene& like) {
  Scene scene;
  scene.cloth.mesh = like.cloth.mesh;
  if (like.cloth.is_mesh()) scene.cloth.origin.setZero();
  scene.springs = starter_springs;
  scene.damping = starter_damping;
  scene.gravity = starter_gravity;
  scene.air = starter_air;
  scene.air->gust = Gust{};
  scene.deformation = Deformation{};
  scene.contact = ContactSettings{};
  scene.self_contact = SelfContact{};
  scene.integrator.method = like.integrator.method;
  for (const Obstacle& obstacle : like.obstacles)
    scene.obstacles.push_back(starter_obstacle(obstacle.shape, like.cloth));
  return scene;
}

std::optional<std::size_t> obstacle_index(const std::string& path) {
  constexpr std::string_view prefix = "obstacles.";
  if (path.rfind(prefix, 0) != 0) return std::nullopt;
  std::size_t index = 0;
  const char* end = path.data() + path.size();
  const auto [stop, error] = std::from_chars(path.data() + prefix.size(), end, index);
  if (error != std::errc() || stop != end) return std::nullopt;
  return index;
}

}  // namespace

std::vector<Block> blocks_of(const Scene& scene) {
  std::vector<Block> blocks;
  blocks.push_back({"integrator", "Integrator", "How time advances.", false,
                    bound<IntegratorChoice>("integrator", integrator_fields(scene.integrator.method),
                                            [](Scene& s) -> IntegratorChoice& { return s.integrator; })});
  if (scene.springs)
    blocks.push_back({"springs", "Springs", "What holds the cloth together.", true,
                      bound<SpringMaterial>("springs", spring_fields(),
                                            [](Scene& s) -> SpringMaterial& { return s.springs.value(); })});
  if (scene.deformation)
    blocks.push_back({"deformation", "Deformation rate", "Provot's limit on how far springs may stretch.",
                      true,
                      bound<Deformation>("deformation", deformation_fields(),
                                         [](Scene& s) -> Deformation& { return s.deformation.value(); })});
  if (scene.damping)
    blocks.push_back(
        {"damping", "Viscous damping", "Resistance to every motion.", true, root_parameters({"damping"})});
  if (scene.gravity)
    blocks.push_back({"gravity", "Gravity", "The weight of the cloth.", true, root_parameters({"gravity"})});
  if (scene.air) {
    blocks.push_back({"air", "Air and wind", "Air that drags and blows along the cloth's normals.", true,
                      bound<Air>("air", air_fields(), [](Scene& s) -> Air& { return s.air.value(); })});
    if (scene.air->gust)
      blocks.push_back({"air.gust", "Gusts", "A wind whose speed swings.", true,
                        bound<Gust>("air.gust", gust_fields(),
                                    [](Scene& s) -> Gust& { return s.air.value().gust.value(); })});
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) blocks.push_back(obstacle_block(scene, i));
  add_contact_blocks(scene, blocks);
  blocks.push_back({"cloth", "Cloth",
                    scene.cloth.is_mesh() ? "A mesh: its vertices are particles, its edges springs."
                                          : "The sheet: how many particles, how large, how heavy.",
                    false,
                    bound<ClothSheet>("cloth", cloth_fields(scene.cloth.is_mesh()),
                                      [](Scene& s) -> ClothSheet& { return s.cloth; })});
  blocks.push_back(run_block());
  return blocks;
}

std::vector<Parameter> parameters_of(const Scene& scene) {
  std::vector<Parameter> parameters;
  for (Block& block : blocks_of(scene))
    for (Parameter& parameter : block.parameters) parameters.push_back(std::move(parameter));
  return parameters;
}

std::optional<Parameter> find_parameter(const Scene& scene, const std::string& path) {
  for (Parameter& parameter : parameters_of(scene))
    if (parameter.path == path) return std::move(parameter);
  return std::nullopt;
}

std::vector<BlockOffer> offers_for(const Scene& scene) {
  std::vector<BlockOffer> offers;
  if (!scene.springs)
    offers.push_back({"springs", "Springs", "What holds the cloth together.",
                      [](Scene& s) { s.springs = starter_springs; }});
  if (!scene.deformation)
    offers.push_back({"deformation", "Deformation rate", "Provot's limit on how far springs may stretch.",
                      [](Scene& s) { s.deformation = Deformation{}; }});
  if (!scene.damping)
    offers.push_back({"damping", "Viscous damping", "Resistance to every motion.",
                      [](Scene& s) { s.damping = starter_damping; }});
  if (!scene.gravity)
    offers.push_back(
        {"gravity", "Gravity", "The weight of the cloth.", [](Scene& s) { s.gravity = starter_gravity; }});
  if (!scene.air)
    offers.push_back({"air", "Air and wind", "Air that drags and blows along the cloth's normals.",
                      [](Scene& s) { s.air = starter_air; }});
  if (scene.air && !scene.air->gust)
    offers.push_back(
        {"air.gust", "Gusts", "A wind whose speed swings.", [](Scene& s) { s.air->gust = Gust{}; }});
  if (!scene.contact && !scene.obstacles.empty())
    offers.push_back({"contact", "Contact", "Contact without gaps: no vertex, edge or face comes through.",
                      [](Scene& s) { s.contact = ContactSettings{}; }});
  if (!scene.self_contact)
    offers.push_back({"self_contact", "Self-contact", "The cloth does not pass through itself.",
                      [](Scene& s) { s.self_contact = starter_self_contact(s.cloth); }});
  const auto obstacle = [&](Shape shape, const char* title, const char* doc) {
    offers.push_back({name_of(shape), title, doc, [shape](Scene& s) {
                        s.obstacles.push_back(starter_obstacle(shape, s.cloth));
                        load_meshes(s);
                      }});
  };
  obstacle(Shape::sphere, "Sphere", "A ball under the cloth.");
  obstacle(Shape::box, "Box", "A cube or rectangle under the cloth.");
  obstacle(Shape::plane, "Plane", "A floor under the cloth.");
  obstacle(Shape::mesh, "Mesh", "A body of any shape under the cloth, from an OBJ file.");
  return offers;
}

void remove_block(Scene& scene, const std::string& path) {
  if (path == "springs") scene.springs.reset();
  if (path == "deformation") scene.deformation.reset();
  if (path == "damping") scene.damping.reset();
  if (path == "gravity") scene.gravity.reset();
  if (path == "air") scene.air.reset();
  if (path == "contact") scene.contact.reset();
  if (path == "self_contact") scene.self_contact.reset();
  if (path == "air.gust" && scene.air) scene.air->gust.reset();
  if (const auto index = obstacle_index(path); index && *index < scene.obstacles.size())
    scene.obstacles.erase(scene.obstacles.begin() + static_cast<long>(*index));
}

std::optional<ParameterValue> default_of(const Scene& scene, const std::string& path) {
  const Scene starter = starter_scene(scene);
  const auto parameter = find_parameter(starter, path);
  if (!parameter) return std::nullopt;
  return parameter->get(starter);
}

}  // namespace cloth
