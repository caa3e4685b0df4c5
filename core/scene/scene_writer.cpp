#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/fnv_hash.h"
#include "scene/blocks.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

struct ToJson {
  json operator()(double value) const { return value; }
  json operator()(std::int64_t value) const { return value; }
  json operator()(const Vec3& v) const { return json::array({v.x(), v.y(), v.z()}); }
  json operator()(const std::string& value) const { return value; }
  json operator()(const Words& value) const { return value; }
};

template <class List, class Owner>
void put_fields(const List& fields, const Owner& owner, json& into) {
  for (const auto& field : fields) into[field.info.key] = std::visit(ToJson{}, field.get(owner));
}

/// Of a mesh the pins are vertices.
json pins_json(const ClothSheet& cloth) {
  json list = json::array();
  for (const Pin& pin : cloth.pins) {
    const auto* particle = std::get_if<PinnedParticle>(&pin);
    if (particle && cloth.is_mesh())
      list.push_back(particle->column);
    else if (particle)
      list.push_back({particle->row, particle->column});
    else if (const auto* disc = std::get_if<PinnedDisc>(&pin))
      list.push_back({{"disc", disc->radius}});
    else
      list.push_back(name_of(std::get<NamedPin>(pin)));
  }
  return list;
}

/// What does not move says nothing of motion.
void put_motion(const Obstacle& obstacle, json& into) {
  if (!obstacle.velocity.isZero(0) || !obstacle.spin.isZero(0)) put_fields(motion_fields(), obstacle, into);
  for (const Keyframe& key : obstacle.keyframes)
    put_fields(keyframe_fields(), key, into["keyframes"].emplace_back(json::object()));
}

json obstacles_json(const Scene& scene) {
  json list = json::array();
  for (const Obstacle& obstacle : scene.obstacles) {
    json entry{{"shape", shape_of(obstacle).name}};
    put_fields(obstacle_fields(obstacle.shape), obstacle, entry);
    put_motion(obstacle, entry);
    list.push_back(std::move(entry));
  }
  return list;
}

json probes_json(const Scene& scene) {
  json list = json::array();
  for (const Probe& probe : scene.probes) {
    const ProbeFacts& facts = facts_of(probe.measure);
    json entry;
    put_fields(Fields<Probe>{probe_fields(probe.measure).front()}, probe, entry);
    entry["measure"] = facts.name;
    if (facts.is_of_particles()) entry["particles"] = json::array();
    for (const ParticlePlace& at : probe.particles)
      entry["particles"].push_back(scene.cloth.is_mesh() ? json(at.column) : json{at.row, at.column});
    put_fields(probe_fields(probe.measure), probe, entry);
    list.push_back(std::move(entry));
  }
  return list;
}

/// The place of `path` below `root`, made where it is missing.
json& object_at(json& root, const std::string& path) {
  if (path.empty()) return root;
  return object_at(root, parent_path(path))[path.substr(path.rfind('.') + 1)];
}

json scene_json(const Scene& scene) {
  json root;
  root["format"] = scene_format;
  for (const BlockRow* row : block_rows_of_file()) {
    if (!row->is_present(scene)) continue;
    if (row->path == "obstacles") root["obstacles"] = obstacles_json(scene);
    if (row->path == "probes") root["probes"] = probes_json(scene);
    for (const Parameter& parameter : row->parameters(scene))
      object_at(root, parameter.path) = std::visit(ToJson{}, parameter.get(scene));
    if (row->path == "cloth") root["cloth"]["pins"] = pins_json(scene.cloth);
  }
  return root;
}

/// Short arrays and objects of plain values stay on one line: a scene is read by people.
void print(const json& value, int indent, std::string& out) {
  const std::string flat = value.dump(-1, ' ', false, json::error_handler_t::replace);
  const bool nested = value.is_structured() &&
                      std::any_of(value.begin(), value.end(), [](const json& v) { return v.is_object(); });
  constexpr std::size_t line_length = 100;
  if (!value.is_structured() ||
      (!nested && (value.is_array() || flat.size() + 2 * indent < line_length) && indent > 0)) {
    std::string spaced;
    bool quoted = false;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      spaced += flat[i];
      if (flat[i] == '"' && (i == 0 || flat[i - 1] != '\\')) quoted = !quoted;
      if (!quoted && (flat[i] == ',' || flat[i] == ':')) spaced += ' ';
    }
    out += spaced;
    return;
  }
  const std::string pad(static_cast<std::size_t>(2 * (indent + 1)), ' ');
  out += value.is_object() ? "{\n" : "[\n";
  std::size_t left = value.size();
  for (auto it = value.begin(); it != value.end(); ++it) {
    out += pad;
    if (value.is_object()) out += fmt::format("{}: ", json(it.key()).dump());
    print(*it, indent + 1, out);
    out += --left ? ",\n" : "\n";
  }
  out += std::string(static_cast<std::size_t>(2 * indent), ' ') + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string write_scene(const Scene& scene) {
  std::string out;
  print(scene_json(scene), 0, out);
  return out + "\n";
}

std::string value_json(const ParameterValue& value) {
  std::string out;
  print(std::visit(ToJson{}, value), 1, out);
  return out;
}

std::string scene_hash(const Scene& scene) {
  FnvHash hash;
  hash.add(write_scene(scene));
  const auto add = [&](const MeshChoice& mesh) {
    if (mesh.is_loaded()) hash.add(mesh.loaded->hash);
  };
  add(scene.cloth.mesh);
  for (const Obstacle& obstacle : scene.obstacles) add(obstacle.mesh);
  return hash.text();
}

}  // namespace cloth
