#include "scene/scene_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/obstacle_shape.h"
#include "scene/scene_cloth.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

void check_parameters(const Scene& scene, std::vector<Problem>& problems) {
  for (const Parameter& parameter : parameters_of(scene)) {
    const ParameterValue value = parameter.get(scene);
    if (const auto rule = broken_rule(parameter.info, value))
      problems.push_back({parameter.path, value_text(parameter.info, value), *rule});
  }
}

/// Of meshes that load_meshes() could not read, or has not been asked for.
void check_meshes(const Scene& scene, std::vector<Problem>& problems) {
  const auto check = [&](const std::string& path, const MeshChoice& mesh) {
    if (!mesh.is_loaded()) problems.push_back({path, '"' + mesh.file + '"', "has not been read"});
  };
  if (scene.cloth.is_mesh()) check("cloth.mesh", scene.cloth.mesh);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
    if (shape_of(scene.obstacles[i]).is_from_file)
      check(fmt::format("obstacles.{}.file", i), scene.obstacles[i].mesh);
}

/// As the file has it.
std::string pin_text(const ClothSheet& cloth, const Pin& pin) {
  if (const auto* named = std::get_if<NamedPin>(&pin)) return name_of(*named);
  if (const auto* disc = std::get_if<PinnedDisc>(&pin)) return fmt::format("{{\"disc\": {}}}", disc->radius);
  const auto& particle = std::get<PinnedParticle>(pin);
  return cloth.is_mesh() ? std::to_string(particle.column)
                         : fmt::format("[{}, {}]", particle.row, particle.column);
}

/// Empty where the pin is right.
std::string broken_vertex_rule(const ClothSheet& cloth, const Pin& pin) {
  if (!cloth.mesh.is_loaded()) return "";  // said already
  const auto* one = std::get_if<PinnedParticle>(&pin);
  if (one && one->row == 0 && one->column >= 0 && one->column < cloth.columns) return "";
  return fmt::format("must be a vertex of the mesh: 0 to {}", cloth.columns - 1);
}

std::string broken_grid_rule(const ClothSheet& cloth, const Pin& pin) {
  if (const auto* one = std::get_if<PinnedParticle>(&pin);
      one && !(one->row >= 0 && one->row < cloth.rows && one->column >= 0 && one->column < cloth.columns))
    return fmt::format("must lie in the grid: row 0 to {}, column 0 to {}", cloth.rows - 1,
                       cloth.columns - 1);
  if (const auto* disc = std::get_if<PinnedDisc>(&pin); disc && !(disc->radius > 0))
    return "must have a radius greater than 0 m";
  ClothSheet only = cloth;
  only.pins = {pin};
  if (!pinned_particles(only).empty()) return "";
  return std::holds_alternative<PinnedDisc>(pin)
             ? "must be larger: no particle of this grid lies within it"
             : "must hold a particle: there is none where the cloth is cut away";
}

/// Of a cloth with as many rows and columns as it may have.
void check_pins(const ClothSheet& cloth, std::vector<Problem>& problems) {
  for (std::size_t i = 0; i < cloth.pins.size(); ++i) {
    const Pin& pin = cloth.pins[i];
    const std::string rule = cloth.is_mesh() ? broken_vertex_rule(cloth, pin) : broken_grid_rule(cloth, pin);
    if (!rule.empty()) problems.push_back({fmt::format("cloth.pins.{}", i), pin_text(cloth, pin), rule});
  }
}

/// Springs of a cut border would need masses of their own.
void check_cut(const Scene& scene, std::vector<Problem>& problems) {
  if (scene.cloth.is_cut() && !scene.material)
    problems.push_back(
        {"cloth.cut", "\"round\"", "needs a material: the cloth of a scene with springs is the whole grid"});
}

void check_directions(const ClothSheet& cloth, std::vector<Problem>& problems) {
  if (cloth.is_mesh()) return;
  if (!(cloth.across.norm() > 0) || !(cloth.down.norm() > 0)) return;  // said already
  constexpr double least_sine = 1e-6;
  if (cloth.across.normalized().cross(cloth.down.normalized()).norm() > least_sine) return;
  const Vec3& down = cloth.down;
  problems.push_back({"cloth.down", fmt::format("[{}, {}, {}]", down.x(), down.y(), down.z()),
                      "must not be parallel to cloth.across"});
}

/// Stretched in its plane it must gain energy.
void check_coupling(const Material& m, bool is_mesh, std::vector<Problem>& problems) {
  const double coupling = coupling_of(m), most = std::sqrt(m.stretch_warp * m.stretch_weft);
  const auto refuse = [&](const char* key, double value, const std::string& rule) {
    problems.push_back({std::string("material.") + key, fmt::format("{} N/m", value), rule});
  };
  if (!is_mesh && m.coupling && *m.coupling != m.shear)
    return refuse("coupling", *m.coupling,
                  fmt::format("must be \"auto\" or as much as material.shear, {} N/m: a grid's springs have no "
                              "other; a mesh takes any",
                              m.shear));
  if (is_mesh && coupling > most)
    refuse(m.coupling ? "coupling" : "shear", coupling,
           fmt::format("must be at most {:.6g} N/m, the root of stretch_warp times stretch_weft: a cloth that "
                       "pulls in across by more would gain energy by being stretched{}",
                       most, m.coupling ? "" : "; material.coupling can be less"));
}

void check_hysteresis(const Material& m, std::vector<Problem>& problems) {
  const auto check = [&](const char* direction, double hysteresis, double bending) {
    if (!(hysteresis > 0) || bending > 0) return;
    problems.push_back({fmt::format("material.hysteresis_{}", direction), fmt::format("{} N", hysteresis),
                        fmt::format("must be 0 where material.bending_{} is: friction without stiffness would "
                                    "keep every fold",
                                    direction)});
  };
  check("warp", m.hysteresis_warp, m.bending_warp);
  check("weft", m.hysteresis_weft, m.bending_weft);
}

/// A material becomes triangles, or springs of cells that are rectangles, none of them negative.
void check_material(const Scene& scene, std::vector<Problem>& problems) {
  if (!scene.material) return;
  const ClothSheet& cloth = scene.cloth;
  check_coupling(*scene.material, cloth.is_mesh(), problems);
  check_hysteresis(*scene.material, problems);
  if (!(cloth.across.norm() > 0) || !(cloth.down.norm() > 0)) return;  // said already
  constexpr double largest_cosine = 1e-9;
  if (std::abs(cloth.across.normalized().dot(cloth.down.normalized())) > largest_cosine) {
    const Vec3& down = cloth.down;
    problems.push_back({"cloth.down", fmt::format("[{}, {}, {}]", down.x(), down.y(), down.z()),
                        cloth.is_mesh()
                            ? "must be at right angles to cloth.across: warp and weft of a material are"
                            : "must be at right angles to cloth.across: the cells of a material are rectangles"});
    return;
  }
  if (cloth.is_mesh()) return;
  const CellSides cell = cell_sides(cloth);
  const double most = largest_shear(*scene.material, cell.across, cell.down);
  if (scene.material->shear <= most) return;
  problems.push_back(
      {"material.shear", fmt::format("{} N/m", scene.material->shear),
       fmt::format("must be at most {:.6g} N/m: the diagonals of cells of {:.4g} m by {:.4g} m resist "
                   "stretching too, by shear (across/down)^2 along the weft ({} N/m) and shear "
                   "(down/across)^2 along the warp ({} N/m), which must be at least as much",
                   most, cell.across, cell.down, scene.material->stretch_weft,
                   scene.material->stretch_warp)});
}

void check_keyframes(const Scene& scene, std::vector<Problem>& problems) {
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const std::vector<Keyframe>& keys = scene.obstacles[k].keyframes;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const std::string path = fmt::format("obstacles.{}.keyframes.{}", k, i);
      for (const Field<Keyframe>& field : keyframe_fields())
        if (const auto rule = broken_rule(field.info, field.get(keys[i])))
          problems.push_back(
              {path + "." + field.info.key, value_text(field.info, field.get(keys[i])), *rule});
      if (i > 0 && !(keys[i].time > keys[i - 1].time))
        problems.push_back({path + ".time", fmt::format("{} s", keys[i].time),
                            fmt::format("must be later than the key before, {} s", keys[i - 1].time)});
    }
  }
}

/// m, of the springs that the cloth would have if it had any.
double shortest_edge(const ClothSheet& cloth) {
  if (!cloth.is_mesh()) return std::min(cloth.width / (cloth.columns - 1), cloth.height / (cloth.rows - 1));
  double shortest = infinity;
  const std::vector<Vec3>& vertices = cloth.mesh.loaded->surface.vertices;
  for (const auto& [a, b] : cloth.mesh.loaded->edges)
    shortest = std::min(
        shortest, (vertices[static_cast<std::size_t>(a)] - vertices[static_cast<std::size_t>(b)]).norm());
  return shortest;
}

void check_self_contact(const Scene& scene, std::vector<Problem>& problems) {
  if (!scene.self_contact || (scene.cloth.is_mesh() && !scene.cloth.mesh.is_loaded())) return;
  const double most = 0.5 * shortest_edge(scene.cloth);
  if (scene.self_contact->thickness <= most) return;
  problems.push_back({"self_contact.thickness", fmt::format("{} m", scene.self_contact->thickness),
                      fmt::format("must be at most half of the shortest structural spring, {:.4g} m", most)});
}

/// m, of a cell's side, of a mesh the mean of its edges.
double cell_size(const ClothSheet& cloth) {
  if (!cloth.is_mesh()) return shortest_edge(cloth);
  if (!cloth.mesh.is_loaded() || cloth.mesh.loaded->edges.empty()) return 0;
  const std::vector<Vec3>& vertices = cloth.mesh.loaded->surface.vertices;
  double sum = 0;
  for (const auto& [a, b] : cloth.mesh.loaded->edges)
    sum += (vertices[static_cast<std::size_t>(a)] - vertices[static_cast<std::size_t>(b)]).norm();
  return sum / static_cast<double>(cloth.mesh.loaded->edges.size());
}

void check_steps(const Scene& scene, std::vector<Problem>& problems) {
  if (!scene.integrator.time_step || !(*scene.integrator.time_step > 0)) return;  // said already
  if (const auto rule = too_many_steps(scene.duration, *scene.integrator.time_step))
    problems.push_back({"duration", fmt::format("{} s", scene.duration), *rule});
}

/// What is made of a list for each of its entries takes time and messages: no real scene has so many.
void check_counts(const Scene& scene, std::vector<Problem>& problems) {
  constexpr std::size_t max_obstacles = 1000, max_keyframes = 100'000, max_probes = 100;
  const auto check = [&](const std::string& path, std::size_t count, std::size_t most) {
    if (count > most)
      problems.push_back({path, "", fmt::format("has {} entries; there may be at most {}", count, most)});
  };
  check("obstacles", scene.obstacles.size(), max_obstacles);
  check("probes", scene.probes.size(), max_probes);
  for (std::size_t k = 0; k < scene.obstacles.size() && k <= max_obstacles; ++k)
    check(fmt::format("obstacles.{}.keyframes", k), scene.obstacles[k].keyframes.size(), max_keyframes);
}

}  // namespace

std::optional<std::string> too_many_steps(double duration, double time_step) {
  const double steps = duration / time_step;
  if (steps <= max_steps_of_run) return std::nullopt;
  return fmt::format("takes {:.3g} steps of {:.6g} s; a run may have at most {:g}", steps, time_step,
                     max_steps_of_run);
}

std::vector<Problem> find_problems(const Scene& scene) {
  std::vector<Problem> problems;
  check_counts(scene, problems);
  if (!problems.empty()) return problems;
  check_parameters(scene, problems);
  check_meshes(scene, problems);
  check_cut(scene, problems);
  const bool has_size = std::none_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.path == "cloth.rows" || problem.path == "cloth.columns";
  });
  if (has_size) {
    check_pins(scene.cloth, problems);
    for (Problem& problem : find_probe_problems(scene)) problems.push_back(std::move(problem));
  }
  check_directions(scene.cloth, problems);
  check_material(scene, problems);
  check_keyframes(scene, problems);
  check_self_contact(scene, problems);
  check_steps(scene, problems);
  return problems;
}

std::vector<std::string> scene_notices(const Scene& scene) {
  constexpr double least_part = 0.01;
  std::vector<std::string> notices = mesh_notices(scene);
  const double cell = cell_size(scene.cloth);
  const auto look_at = [&](const char* path, double thickness) {
    if (thickness >= least_part * cell) return;
    notices.push_back(fmt::format(
        "{} = {:.4g} m is less than a hundredth of a cell, {:.4g} m: it is kept, but by small steps of "
        "contact, which are slow, and the cloth's faces bend by more than that",
        path, thickness, cell));
  };
  if (scene.contact) look_at("contact.thickness", scene.contact->thickness);
  if (scene.self_contact) look_at("self_contact.thickness", scene.self_contact->thickness);
  for (std::string& notice : probe_notices(scene)) notices.push_back(std::move(notice));
  return notices;
}

}  // namespace cloth
