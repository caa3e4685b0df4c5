#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "io/json_reader.h"
#include "io/json_syntax.h"
#include "io/printable.h"
#include "scene/blocks.h"
#include "scene/material_reading.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

using json = nlohmann::json;

/// Takes a JSON document apart block by block. Problems are collected, never thrown.
class SceneReader : public JsonReader<json> {
 public:
  Scene read(const json& root) {
    Scene scene;
    if (!object(root, "")) return scene;
    known_keys(root, "", known_in("", {"format", "obstacles", "probes"}, scene));
    format(root, scene_format);
    required(root, "", "cloth", "must be given: a scene needs a cloth");
    for (const BlockRow* row : block_rows_of_file()) {
      if (row->path == "cloth")
        read_cloth(root, scene.cloth);
      else if (row->path == "obstacles")
        read_obstacles(root, scene.obstacles);
      else if (row->path == "probes")
        read_probes(root, scene);
      else
        read_row(root, *row, scene);
    }
    return scene;
  }

 private:
  template <class List>
  static std::set<std::string> keys_of(const List& declared, std::set<std::string> also = {}) {
    for (const auto& field : declared) also.insert(field.info.key);
    return also;
  }

  /// The keys of an object of the file: all parameters and objects that the rows have in it.
  static std::set<std::string> known_in(const std::string& object, std::set<std::string> also,
                                        const Scene& scene) {
    for (const BlockRow& row : block_rows())
      for (const Parameter& parameter : row.parameters(scene)) {
        const std::string parent = parent_path(parameter.path);
        if (parent == object) also.insert(parameter.info.key);
        if (!parent.empty() && parent_path(parent) == object)
          also.insert(object.empty() ? parent : parent.substr(object.size() + 1));
      }
    return also;
  }

  template <class List, class Owner>
  void fields(const json& from, const std::string& path, const List& declared, Owner& owner) {
    for (const auto& field : declared)
      if (const json* value = member(from, field.info.key))
        if (const auto parsed = parse(*value, joined_path(path, field.info.key), field.info))
          field.set(owner, *parsed);
  }

  /// The object at `path` below `root`; null if there is none.
  static const json* object_at(const json& root, const std::string& path) {
    if (path.empty()) return &root;
    const json* above = object_at(root, parent_path(path));
    return above && above->is_object() ? member(*above, path.substr(path.rfind('.') + 1)) : nullptr;
  }

  /// What settle_material() has taken out of a material before.
  static std::set<std::string> also_known_in(const std::string& object) {
    if (object == "material") return {"preset", "bending_45"};
    return {};
  }

  /// The parameters of a block, object by object of the file.
  void read_row(const json& root, const BlockRow& row, Scene& scene) {
    if (row.path == "integrator") find_method(root, scene.integrator);
    std::map<std::string, std::vector<Parameter>> by_object;
    for (Parameter& parameter : row.parameters(scene)) {
      const std::string parent = parent_path(parameter.path);
      by_object[parent].push_back(std::move(parameter));
    }
    for (const auto& [path, parameters] : by_object) {
      const json* from = object_at(root, path);
      if (!from) continue;
      if (!path.empty()) {
        if (row.optional) row.optional->add(scene);
        if (!object(*from, path)) continue;
        known_keys(*from, path, known_in(path, also_known_in(path), scene));
      }
      fields(*from, path, parameters, scene);
    }
  }

  /// The method decides which other settings are known.
  static void find_method(const json& root, IntegratorChoice& integrator) {
    const json* method = object_at(root, "integrator.method");
    if (method && method->is_string()) integrator.method = method->get<std::string>();
  }

  void read_cloth(const json& root, ClothSheet& cloth) {
    const json* value = member(root, "cloth");
    if (!value || !object(*value, "cloth")) return;
    const bool is_mesh = value->contains("mesh");
    if (is_mesh) cloth.origin.setZero();
    known_keys(*value, "cloth", keys_of(cloth_fields(is_mesh), {"pins"}));
    fields(*value, "cloth", cloth_fields(is_mesh), cloth);
    for (const char* direction : {"across", "down"})
      if (is_mesh && !root.contains("material") && value->contains(direction))
        problem(fmt::format("cloth.{}", direction), (*value)[direction],
                "must be left out: only a material gives a mesh directions");
    if (is_mesh && (*value)["mesh"] == "") problem("cloth.mesh", (*value)["mesh"], "must name a mesh");
    const json* pins = member(*value, "pins");
    if (pins && is_mesh) read_vertex_pins(*pins, cloth.pins);
    if (pins && !is_mesh) read_pins(*pins, cloth.pins);
  }

  void read_vertex_pins(const json& value, std::vector<Pin>& pins) {
    if (!list(value, "cloth.pins")) return;
    for (std::size_t i = 0; i < value.size(); ++i)
      if (small_integer(value[i]))
        pins.emplace_back(PinnedParticle{0, value[i].get<int>()});
      else
        problem(fmt::format("cloth.pins.{}", i), value[i], "must be the number of a vertex, from 0");
  }

  void read_pins(const json& value, std::vector<Pin>& pins) {
    if (!list(value, "cloth.pins")) return;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const json& pin = value[i];
      const std::string path = fmt::format("cloth.pins.{}", i);
      if (pin.is_string()) {
        if (const auto named = pin_named(pin.get<std::string>()))
          pins.emplace_back(*named);
        else
          problem(path, pin,
                  "must be top-left, top-right, bottom-left, bottom-right, top-edge, bottom-edge, left-edge, "
                  "right-edge, [row, column] or {\"disc\": radius}");
      } else if (pin.is_array() && pin.size() == 2 && small_integer(pin[0]) && small_integer(pin[1])) {
        pins.emplace_back(PinnedParticle{pin[0].get<int>(), pin[1].get<int>()});
      } else {
        read_disc(pin, path, pins);
      }
    }
  }

  void read_disc(const json& pin, const std::string& path, std::vector<Pin>& pins) {
    const bool is_disc = pin.is_object() && pin.size() == 1 && pin.contains("disc");
    if (!is_disc || !pin["disc"].is_number())
      return problem(path, pin, "must be a name, [row, column] in whole numbers or {\"disc\": radius in m}");
    pins.emplace_back(PinnedDisc{pin["disc"].get<double>()});
  }

  static bool small_integer(const json& value) {
    return value.is_number_integer() && std::abs(value.get<double>()) < 1e9;
  }

  void read_obstacles(const json& root, std::vector<Obstacle>& obstacles) {
    const json* list = member(root, "obstacles");
    if (!list) return;
    const json& value = *list;
    if (!value.is_array()) return problem("obstacles", value, "must be a list");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string path = fmt::format("obstacles.{}", i);
      Obstacle& obstacle = obstacles.emplace_back();
      if (!object(value[i], path)) continue;
      const json* shape = member(value[i], "shape");
      if (!shape) {
        add_problem(path + ".shape", "must be given: " + shape_names());
        continue;
      }
      const auto known = std::find_if(obstacle_shapes().begin(), obstacle_shapes().end(),
                                      [&](const ObstacleShape* one) { return *shape == one->name; });
      if (known == obstacle_shapes().end()) {
        problem(path + ".shape", *shape, "must be " + shape_names());
        continue;
      }
      obstacle.shape = *known;
      known_keys(value[i], path,
                 keys_of(obstacle_fields(obstacle.shape), keys_of(motion_fields(), {"shape", "keyframes"})));
      fields(value[i], path, obstacle_fields(obstacle.shape), obstacle);
      fields(value[i], path, motion_fields(), obstacle);
      if (const json* keys = member(value[i], "keyframes"))
        read_keyframes(*keys, path + ".keyframes", obstacle);
    }
  }

  void read_probes(const json& root, Scene& scene) {
    const json* value = member(root, "probes");
    if (!value || !list(*value, "probes")) return;
    for (std::size_t i = 0; i < value->size(); ++i) {
      const std::string path = fmt::format("probes.{}", i);
      // What cannot be read must not be found fault with again.
      Probe& probe = scene.probes.emplace_back(
          Probe{.name = fmt::format("unread-{}", i), .measure = ProbeMeasure::lowest_point});
      if (object((*value)[i], path)) read_probe((*value)[i], path, scene.cloth.is_mesh(), probe);
    }
  }

  void read_probe(const json& from, const std::string& path, bool is_mesh, Probe& probe) {
    const std::string names = probe_measure_names();
    const json* measure = required(from, path, "measure", "must be given: " + names);
    required(from, path, "name", "must be given: its columns are called by it");
    if (!measure) return;
    const auto known = std::find_if(probe_facts().begin(), probe_facts().end(),
                                    [&](const ProbeFacts& one) { return *measure == one.name; });
    if (known == probe_facts().end()) return problem(path + ".measure", *measure, "must be " + names);
    probe.measure = known->measure;
    std::set<std::string> keys = keys_of(probe_fields(probe.measure), {"measure"});
    if (known->is_of_particles()) keys.insert("particles");
    known_keys(from, path, keys);
    fields(from, path, probe_fields(probe.measure), probe);
    if (const json* particles = member(from, "particles"); particles && known->is_of_particles())
      read_places(*particles, path + ".particles", is_mesh, probe.particles);
  }

  static std::string probe_measure_names() {
    std::string names;
    for (const ProbeFacts& facts : probe_facts())
      names += fmt::format("{}\"{}\"",
                           names.empty()                     ? ""
                           : &facts == &probe_facts().back() ? " or "
                                                             : ", ",
                           facts.name);
    return names;
  }

  void read_places(const json& value, const std::string& path, bool is_mesh,
                   std::vector<ParticlePlace>& places) {
    const char* rule =
        is_mesh ? "must be the number of a vertex, from 0" : "must be [row, column] in whole numbers";
    if (!list(value, path)) return;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const json& at = value[i];
      if (is_mesh && small_integer(at))
        places.push_back({0, at.get<int>()});
      else if (!is_mesh && at.is_array() && at.size() == 2 && small_integer(at[0]) && small_integer(at[1]))
        places.push_back({at[0].get<int>(), at[1].get<int>()});
      else
        places.push_back({-1, -1}), problem(fmt::format("{}.{}", path, i), at, rule);
    }
  }

  static std::string shape_names() {
    std::string names;
    for (const ObstacleShape* shape : obstacle_shapes())
      names += fmt::format("{}\"{}\"",
                           names.empty()                       ? ""
                           : shape == obstacle_shapes().back() ? " or "
                                                               : ", ",
                           shape->name);
    return names;
  }

  void read_keyframes(const json& value, const std::string& path, Obstacle& obstacle) {
    if (!list(value, path)) return;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string key_path = fmt::format("{}.{}", path, i);
      Keyframe& key = obstacle.keyframes.emplace_back();
      if (!object(value[i], key_path)) continue;
      known_keys(value[i], key_path, keys_of(keyframe_fields()));
      key.position = pivot_of(obstacle);
      fields(value[i], key_path, keyframe_fields(), key);
    }
  }

  std::optional<ParameterValue> parse(const json& value, const std::string& path, const ParameterInfo& info) {
    switch (info.kind) {
      case Kind::number:
        if (value.is_number()) return value.get<double>();
        if (info.auto_allowed && value == "auto") return std::string("auto");
        problem(path, value, info.auto_allowed ? "must be a number or \"auto\"" : "must be a number");
        return std::nullopt;
      case Kind::integer:
        if (value.is_number_integer() && std::abs(value.get<double>()) <= 2e9)
          return value.get<std::int64_t>();
        problem(path, value, "must be a whole number, " + range_text(info));
        return std::nullopt;
      case Kind::vector:
        if (value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() &&
            value[2].is_number())
          return Vec3(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
        problem(path, value, "must be three numbers [x, y, z]");
        return std::nullopt;
      case Kind::choice:
      case Kind::text:
        if (value.is_string() && is_utf8(value.get_ref<const std::string&>()))
          return value.get<std::string>();
        problem(path, value, value.is_string() ? "must be UTF-8 text" : "must be a text in quotes");
        return std::nullopt;
      case Kind::words:
        return parse_words(value, path);
    }
    return std::nullopt;
  }

  std::optional<ParameterValue> parse_words(const json& value, const std::string& path) {
    const bool strings = value.is_array() && std::all_of(value.begin(), value.end(),
                                                         [](const json& word) { return word.is_string(); });
    if (strings) return value.get<Words>();
    problem(path, value, "must be a list of texts");
    return std::nullopt;
  }
};

/// A bare word that is no JSON stands for itself, so that `--set integrator.method=rk4` needs no quotes. So
/// does what is nested too deeply for a value.
json parse_value(const std::string& text) {
  return syntax_problem(text, "") ? json(text) : json::parse(text);
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Walks to the parent of `path`, making objects on the way, and sets its last key; null takes it out.
bool set_at(json& root, const std::string& path, const json& value) {
  constexpr std::ptrdiff_t deepest = 16;  // no parameter lies so deep, and objects are made on the way
  if (std::count(path.begin(), path.end(), '.') > deepest) return false;
  json* at = &root;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    json* next = nullptr;
    if (at->is_array()) {
      const bool digits = !key.empty() && key.size() < 7 && std::all_of(key.begin(), key.end(), is_digit);
      if (!digits || std::stoul(key) >= at->size()) return false;
      next = &(*at)[std::stoul(key)];
    } else if (at->is_object() && !key.empty()) {
      next = &(*at)[key];
    } else {
      return false;
    }
    if (end == path.size()) {
      if (value.is_null() && at->is_object())
        at->erase(key);
      else
        *next = value;
      return true;
    }
    if (next->is_null()) *next = json::object();
    at = next;
    begin = end + 1;
  }
}

/// A material that is set as a whole takes the place of what it replaces: springs, damping, mass and drag.
void apply_overrides(const std::vector<Override>& overrides, json& document, std::vector<Problem>& problems) {
  name_preset(document);
  for (const Override& override_ : overrides) {
    const json value = parse_value(override_.value);
    if (!set_at(document, override_.path, value))
      problems.push_back({override_.path, override_.value, "there is no such parameter in this scene"});
    if (override_.path != "material" || value.is_null()) continue;
    name_preset(document);
    take_out_replaced(document);
  }
}

/// Finds for every problem the most precise place that the text has for it.
class Placer {
 public:
  Placer(const std::string& text, std::string place, const std::vector<Override>& overrides)
      : locations_(locate_json(text)), place_(std::move(place)), overrides_(overrides) {}

  void operator()(Problem& problem) const {
    for (const Override& override_ : overrides_) {
      const bool set = problem.path == override_.path || problem.path.rfind(override_.path + ".", 0) == 0;
      const bool brought_in =
          override_.path.rfind(problem.path + ".", 0) == 0 && !locations_.values.count(problem.path);
      if (set || brought_in) {
        problem.place = "--set";
        return;
      }
    }
    locations_.put_in_place(problem, place_);
  }

  std::vector<Problem> repetitions() const { return locations_.repetitions(); }

 private:
  JsonLocations locations_;
  std::string place_;
  const std::vector<Override>& overrides_;
};

}  // namespace

std::optional<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return std::nullopt;
  return Override{text.substr(0, equals), text.substr(equals + 1)};
}

SceneReading read_scene(const std::string& text, const std::string& place,
                        const std::vector<Override>& overrides, const MeshSource& meshes,
                        const SceneCheck& further) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  json document = json::parse(text);
  const Placer place_problem(text, place, overrides);

  SceneReader reader;
  reader.problems = place_problem.repetitions();
  apply_overrides(overrides, document, reader.problems);
  const SceneFolder folder =
      meshes.folder.value_or(SceneFolder{std::filesystem::path(place).parent_path().string()});
  for (Problem& problem : settle_material(document, folder)) reader.problems.push_back(std::move(problem));
  Scene scene = reader.read(document);
  scene.folder = folder;
  for (Problem& problem : load_meshes(scene, meshes.known)) reader.problems.push_back(std::move(problem));
  std::set<std::string> named;
  for (const Problem& problem : reader.problems) named.insert(problem.path);
  for (Problem& problem : find_problems(scene))
    if (!named.count(problem.path)) reader.problems.push_back(std::move(problem));
  if (reader.problems.empty() && further) reader.problems = further(scene);

  if (reader.problems.empty()) return {std::move(scene), {}};
  for (Problem& problem : reader.problems) place_problem(problem);
  sort_by_place(reader.problems);
  return {std::nullopt, std::move(reader.problems)};
}

}  // namespace cloth
