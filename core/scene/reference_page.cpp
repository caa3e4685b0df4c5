#include <fmt/format.h>

#include <map>
#include <set>

#include "scene/method_facts.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

/// A scene that has every block once, but a material: that is in place of other blocks.
Scene full_scene() {
  Scene scene;
  add_every_block(scene);
  for (const Shape shape : obstacle_shapes()) scene.obstacles.emplace_back().shape = shape;
  return scene;
}

std::string allowed(const ParameterInfo& info) {
  switch (info.kind) {
    case Kind::choice:
      return fmt::format("`{}`", fmt::join(info.choices, "`, `"));
    case Kind::words: {
      std::string text;
      for (const Words& set : info.word_sets)
        text += fmt::format("{}`{}`", text.empty() ? "" : ", ", value_text(info, set));
      return text;
    }
    case Kind::text:
      return "any text";
    case Kind::integer:
      return "whole, " + range_text(info);
    case Kind::vector:
      return info.unit_vector ? "a direction, not zero" : "three numbers, " + range_text(info);
    case Kind::number:
      return range_text(info) + (info.auto_allowed ? ", or `\"auto\"`" : "");
  }
  return "";
}

/// "obstacles.0.radius" is one of many: obstacles.N.radius.
std::string general_path(const std::string& path) {
  for (const std::string list : {"obstacles.", "probes."})
    if (path.rfind(list, 0) == 0) return list + "N" + path.substr(path.find('.', list.size()));
  return path;
}

/// A bar inside a table cell would end the cell.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string row(const Scene& scene, const Parameter& parameter, const std::string& only_for = "") {
  const ParameterInfo& info = parameter.info;
  const auto initial = default_of(scene, parameter.path);
  return fmt::format("| `{}`{} | {} | {} | {} | {} | {}{} | {} |\n", general_path(parameter.path), only_for,
                     info.label, info.unit.empty() ? "1" : info.unit, allowed(info),
                     initial ? value_text(info, *initial) : "", info.doc,
                     info.formula.empty() ? "" : " `" + cell(info.formula) + "`",
                     info.cost == EditCost::live ? "at the next step" : "restarts");
}

/// What some methods have beside the settings of all: one row for the methods that share it.
std::string method_settings() {
  std::map<MethodSettings, std::vector<std::string>> methods;
  for (const MethodFacts& facts : integrator_facts()) methods[facts.settings].push_back(facts.name);
  methods.erase(MethodSettings::none);
  std::string rows;
  for (const auto& [settings, names] : methods) {
    Scene scene;
    scene.integrator.method = names.front();
    const std::vector<Block> blocks = blocks_of(scene);  // the integrator's comes first
    for (const Parameter& parameter : blocks.front().parameters)
      if (parameter.path != "integrator.method" && parameter.path != "integrator.time_step")
        rows += row(scene, parameter, fmt::format(" of `{}`", fmt::join(names, "`, `")));
  }
  return rows;
}

/// What a cloth of a material has beside, and what a cloth from a mesh has in place of rows, columns, lengths
/// and directions.
std::string other_cloth_settings() {
  Scene cut, mesh;
  cut.material.emplace();
  mesh.cloth.mesh.file = "disc.obj";
  return row(cut, find_parameter(cut, "cloth.cut").value(), " of a material's grid") +
         row(mesh, find_parameter(mesh, "cloth.mesh").value(), " of a mesh");
}

std::string section(const Scene& scene, const Block& block) {
  std::string text = fmt::format(
      "\n## {}\n\n{}\n\n| path | label | unit | accepted | start value | meaning | an edit acts |\n"
      "|---|---|---|---|---|---|---|\n",
      block.title, block.doc);
  for (const Parameter& parameter : block.parameters) text += row(scene, parameter);
  return text;
}

/// The measures, what each records, and their parameters, each key once.
std::string probe_section() {
  std::string text =
      "\n## Probes\n\nWhat is measured, recorded as columns `probe.NAME.…` and charted; a probe only looks "
      "on.\n\n"
      "| `measure` | particles | meaning | columns |\n|---|---|---|---|\n";
  Scene scene;
  for (const ProbeFacts& facts : probe_facts()) {
    const std::string particles = facts.least_particles == facts.most_particles
                                      ? std::to_string(facts.most_particles)
                                      : fmt::format("{} to {}", facts.least_particles, facts.most_particles);
    std::string columns;
    for (const ProbeValue& value : facts.values)
      columns += fmt::format("{}`{}`: {}", columns.empty() ? "" : "; ", value.key, value.doc);
    text += fmt::format("| `{}` | {} | {} | {} |\n", facts.name, facts.is_of_particles() ? particles : "none",
                        facts.doc, columns);
    scene.probes.push_back({.name = "NAME", .measure = facts.measure});
  }
  text +=
      "\n| path | label | unit | accepted | start value | meaning | an edit acts |\n"
      "|---|---|---|---|---|---|---|\n";
  std::set<std::string> told;
  for (const Block& block : blocks_of(scene))
    for (const Parameter& parameter : block.parameters) {
      if (block.path.rfind("probes.", 0) != 0 || !told.insert(parameter.info.key).second) continue;
      const ProbeFacts& facts = facts_of(scene.probes[std::stoul(block.path.substr(7))].measure);
      text += row(scene, parameter, parameter.info.key == "name" ? "" : fmt::format(" of `{}`", facts.name));
    }
  return text;
}

std::string material_section() {
  Scene scene;
  scene.material.emplace();
  for (const Block& block : blocks_of(scene))
    if (block.path == "material") return section(scene, block);
  return "";
}

}  // namespace

std::string reference_page() {
  const Scene scene = full_scene();
  std::string page =
      "# Parameters\n\nMade from the declarations in `core/scene/*_declarations.cpp` by `clothlab-cli "
      "parameters`; do "
      "not edit. \"Start value\" is what the window fills in when a block is added and what a reset returns "
      "to. A "
      "stiffness, damping or block that a file does not name is absent physics.\n";
  for (const Block& block : blocks_of(scene)) {
    page += section(scene, block);
    if (block.path == "integrator") page += method_settings();
    if (block.path == "cloth") page += other_cloth_settings();
    if (block.path == "springs") page += material_section();
    if (block.path == "self_contact") page += probe_section();
  }
  return page;
}

}  // namespace cloth
