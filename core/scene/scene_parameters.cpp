#include "scene/scene_parameters.h"

#include <algorithm>
#include <charconv>

#include "scene/blocks.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

Block obstacle_block(const Scene& scene, std::size_t index) {
  const Shape shape = scene.obstacles[index].shape;
  const std::string path = "obstacles." + std::to_string(index);
  const auto same_before =
      std::count_if(scene.obstacles.begin(), scene.obstacles.begin() + static_cast<long>(index),
                    [&](const Obstacle& other) { return other.shape == shape; });
  const auto of_scene = [index](Scene& s) -> Obstacle& { return s.obstacles.at(index); };
  std::vector<Parameter> parameters = bound<Obstacle>(path, obstacle_fields(shape), of_scene);
  for (Parameter& parameter : bound<Obstacle>(path, motion_fields(), of_scene))
    parameters.push_back(std::move(parameter));
  return {path, std::string(shape->title) + " " + std::to_string(same_before + 1),
          "An obstacle that the cloth's particles cannot enter.", true, std::move(parameters)};
}

Block probe_block(const Scene& scene, std::size_t index) {
  const Probe& probe = scene.probes[index];
  const std::string path = "probes." + std::to_string(index);
  return {path, "Probe " + probe.name, facts_of(probe.measure).doc, true,
          bound<Probe>(path, probe_fields(probe.measure),
                       [index](Scene& s) -> Probe& { return s.probes.at(index); })};
}

/// Of a cloth from a mesh that is loaded, as its file has it.
Eigen::AlignedBox3d bounds_of(const ClothSheet& cloth) {
  return cloth.mesh.is_loaded() ? cloth.mesh.loaded->bounds : Eigen::AlignedBox3d(Vec3(Vec3::Zero()));
}

/// The height at which a new obstacle meets the cloth: below its lower edge if it hangs, under its middle if
/// it lies.
Vec3 middle_of(const ClothSheet& cloth) {
  if (cloth.is_mesh()) return cloth.origin + bounds_of(cloth).center();
  return cloth.origin + 0.5 * cloth.width * cloth.across.normalized() +
         0.5 * cloth.height * cloth.down.normalized();
}

Obstacle starter_obstacle(const ObstacleShape& shape, const ClothSheet& cloth) {
  Obstacle obstacle;
  obstacle.shape = &shape;
  const double span =
      cloth.is_mesh() ? bounds_of(cloth).sizes().maxCoeff() : std::max(cloth.width, cloth.height);
  shape.start(obstacle, middle_of(cloth), span);
  return obstacle;
}

/// Of a cloth smaller than Cusick's the disc is half as wide.
Probe starter_probe(const Scene& scene, ProbeMeasure measure) {
  Probe probe{.name = free_probe_name(scene.probes, measure), .measure = measure};
  const ClothSheet& cloth = scene.cloth;
  const double span =
      cloth.is_mesh() ? bounds_of(cloth).sizes().maxCoeff() : std::min(cloth.width, cloth.height);
  if (span > 0) probe.radius = std::min(probe.radius, 0.25 * span);
  return probe;
}

/// A scene in which every optional block has its starting values: what "default" means.
Scene starter_scene(const Scene& like) {
  Scene scene;
  scene.cloth.mesh = like.cloth.mesh;
  if (like.cloth.is_mesh()) scene.cloth.origin.setZero();
  if (like.material) scene.material.emplace();  // then it is what is added, not springs
  add_every_block(scene);
  scene.integrator.method = like.integrator.method;
  for (const Obstacle& obstacle : like.obstacles)
    scene.obstacles.push_back(starter_obstacle(shape_of(obstacle), like.cloth));
  for (const Probe& probe : like.probes)
    scene.probes.push_back({.name = probe.name, .measure = probe.measure});
  return scene;
}

/// The number of an entry of a list, by the path of its block.
std::optional<std::size_t> entry_index(const std::string& path, std::string_view prefix) {
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
  for (const BlockRow& row : block_rows()) {
    if (row.path == "obstacles")
      for (std::size_t i = 0; i < scene.obstacles.size(); ++i) blocks.push_back(obstacle_block(scene, i));
    if (row.path == "probes")
      for (std::size_t i = 0; i < scene.probes.size(); ++i) blocks.push_back(probe_block(scene, i));
    if (row.title.empty() || !row.is_present(scene)) continue;
    const bool of_mesh = scene.cloth.is_mesh() && !row.mesh_doc.empty();
    blocks.push_back({row.path, row.title, of_mesh ? row.mesh_doc : row.doc, row.optional.has_value(),
                      row.parameters(scene)});
  }
  return blocks;
}

void add_every_block(Scene& scene) {
  for (const BlockRow& row : block_rows())
    if (row.optional) row.optional->start(scene);
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
  for (const BlockRow& row : block_rows())
    if (row.optional && !row.is_present(scene) && row.optional->suits(scene))
      offers.push_back({row.path, row.title, row.doc, row.optional->start});
  for (const ObstacleShape* shape : obstacle_shapes())
    offers.push_back({shape->name, shape->title, shape->doc,
                      [shape](Scene& s) {
                        s.obstacles.push_back(starter_obstacle(*shape, s.cloth));
                        load_meshes(s);
                      },
                      BlockOffer::Group::obstacle});
  for (const ProbeFacts& facts : probe_facts())
    if (!facts.is_of_particles())
      offers.push_back(
          {facts.name, facts.title, facts.doc,
           [measure = facts.measure](Scene& s) { s.probes.push_back(starter_probe(s, measure)); },
           BlockOffer::Group::probe});
  return offers;
}

void remove_block(Scene& scene, const std::string& path) {
  for (const BlockRow& row : block_rows())
    if (row.path == path && row.optional) row.optional->remove(scene);
  const auto erase = [&](auto& list, std::string_view prefix) {
    if (const auto index = entry_index(path, prefix); index && *index < list.size())
      list.erase(list.begin() + static_cast<long>(*index));
  };
  erase(scene.obstacles, "obstacles.");
  erase(scene.probes, "probes.");
}

std::optional<ParameterValue> default_of(const Scene& scene, const std::string& path) {
  const Scene starter = starter_scene(scene);
  const auto parameter = find_parameter(starter, path);
  if (!parameter) return std::nullopt;
  return parameter->get(starter);
}

}  // namespace cloth
