#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "scene/material_file.h"

namespace clothlab::cli {
namespace {

using json = nlohmann::ordered_json;

struct MaterialsArguments {
  std::string name;
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

int materials(const MaterialsArguments& arguments) {
  if (!arguments.name.empty()) return print_one(arguments);
  return print(arguments.json ? list_json() : list_text());
}

}  // namespace

void add_materials(Program& program) {
  auto [command, arguments] =
      add_command(program, "materials", "List the built-in materials, or print one", materials);
  command.add_option("name", arguments.name, "The material to print");
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
