#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "scene/material_conversion.h"
#include "scene/material_file.h"

namespace clothlab::cli {
namespace {

using json = nlohmann::ordered_json;

struct MaterialsArguments {
  std::string name, of, springs_of;
  std::vector<std::string> settings;
  bool json = false;
};

int print_one(const MaterialsArguments& arguments) {
  if (const cloth::BuiltinMaterial* one = cloth::find_builtin_material(arguments.name))
    return print(one->text);
  say(fmt::format("{}: there is no built-in material of this name; 'clothlab-cli materials' lists them",
                  arguments.name));
  return bad_input;
}

std::string list_text() {
  std::string text = fmt::format("{:<20} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  {}\n", "name", "kg/m2",
                                 "C11 N/m", "C22 N/m", "C66 N/m", "warp Nm", "weft Nm", "twist Nm", "source");
  for (const cloth::BuiltinMaterial& one : cloth::builtin_materials()) {
    const cloth::MaterialFile file = cloth::builtin_material(one.name);
    const cloth::Material& m = file.material;
    text +=
        fmt::format("{:<20} {:>7.4g} {:>9.4g} {:>9.4g} {:>9.4g} {:>9.3g} {:>9.3g} {:>9.3g}  {}\n", one.name,
                    m.areal_density, m.stretch_warp, m.stretch_weft, m.shear, m.bending_warp, m.bending_weft,
                    m.twist, file.source.author.empty() ? "typical values" : file.source.text());
  }
  return text +
         "\n'clothlab-cli materials NAME' prints one with its title, what was measured and what was "
         "assumed.\n";
}

std::string list_json() {
  json list = json::array();
  for (const cloth::BuiltinMaterial& one : cloth::builtin_materials()) {
    json entry{{"name", one.name}};
    entry.update(json::parse(cloth::write_material_file(cloth::builtin_material(one.name))));
    entry.erase("format");
    list.push_back(std::move(entry));
  }
  return json{{"materials", std::move(list)}}.dump(2) + "\n";
}

/// The scene, what of it was lost on standard error.
LoadedScene converted(const std::string& name, const std::vector<std::string>& settings,
                      cloth::SceneConversion (*convert)(const cloth::Scene&)) {
  LoadedScene loaded = load_scene(name, settings);
  if (!loaded.scene) return loaded;
  cloth::SceneConversion conversion = convert(*loaded.scene);
  if (!conversion.scene) {
    say(name + ": " + conversion.refusal);
    return {std::nullopt, bad_input};
  }
  for (const std::string& loss : conversion.losses) say(loss);
  return {std::move(conversion.scene)};
}

int print_material_of(const MaterialsArguments& arguments) {
  const LoadedScene loaded = converted(arguments.of, arguments.settings, cloth::with_material);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::ClothSheet& sheet = loaded.scene->cloth;
  const cloth::MaterialSource source{
      .assumed = fmt::format("What the springs of this scene are inside a grid of {} rows and {} columns.",
                             sheet.rows, sheet.columns)};
  return print(cloth::write_material_file({loaded.scene->title, source, *loaded.scene->material}));
}

int print_springs_of(const MaterialsArguments& arguments) {
  const LoadedScene loaded = converted(arguments.springs_of, arguments.settings, cloth::with_springs);
  return loaded.scene ? print(cloth::write_scene(*loaded.scene)) : loaded.exit_code;
}

int materials(const MaterialsArguments& arguments) {
  if (!arguments.of.empty()) return print_material_of(arguments);
  if (!arguments.springs_of.empty()) return print_springs_of(arguments);
  if (!arguments.name.empty()) return print_one(arguments);
  return print(arguments.json ? list_json() : list_text());
}

}  // namespace

void add_materials(Program& program) {
  auto [command, arguments] =
      add_command(program, "materials", "List the built-in materials, or print one", materials);
  CLI::Option* name = command.add_option("name", arguments.name, "The material to print");
  CLI::Option* of =
      command.add_option("--of", arguments.of, "Print the material that the springs of this scene are");
  CLI::Option* springs_of = command.add_option("--springs-of", arguments.springs_of,
                                               "Print this scene with springs in place of its material");
  add_settings(command, arguments.settings);
  for (CLI::Option* one : {of, springs_of}) one->excludes(name)->type_name("SCENE");
  of->excludes(springs_of);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
