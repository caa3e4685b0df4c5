#include "commands.h"
#include "compare/comparison_json.h"
#include "console.h"
#include "scene/material_file.h"
#include "scene/scene_json.h"
#include "scene/scene_parameters.h"
#include "sweep/sweep_plan.h"

namespace clothlab::cli {

namespace {

struct SchemaArguments {
  bool of_comparison = false, of_material = false, of_sweep = false,
       json = false;  ///< a schema is JSON, asked for or not
};

int schema(const SchemaArguments& arguments) {
  if (arguments.of_sweep) return print(cloth::sweep_schema());
  if (arguments.of_material) return print(cloth::material_schema());
  return print(arguments.of_comparison ? cloth::comparison_schema() : cloth::scene_schema());
}

struct NoArguments {};

int parameters(const NoArguments&) {
  return print(cloth::reference_page());
}

}  // namespace

void add_schema(Program& program) {
  auto [command, arguments] =
      add_command(program, "schema", "Print the JSON Schema of the scene file", schema);
  CLI::Option* comparison =
      command.add_flag("--comparison", arguments.of_comparison, "Of the comparison file instead");
  CLI::Option* material =
      command.add_flag("--material", arguments.of_material, "Of the material file instead")
          ->excludes(comparison);
  command.add_flag("--sweep", arguments.of_sweep, "Of the plan of a sweep instead")
      ->excludes(comparison)
      ->excludes(material);
  add_json(command, arguments.json);
}

void add_parameters(Program& program) {
  add_command(program, "parameters", "Print the reference page of all parameters (Markdown)", parameters);
}

}  // namespace clothlab::cli
