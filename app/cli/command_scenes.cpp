#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "scene/builtin_scenes.h"

namespace clothlab::cli {
namespace {

struct ScenesArguments {
  std::string name;
  bool json = false;
};

int print_one(const ScenesArguments& arguments) {
  const cloth::BuiltinScene* scene = cloth::find_builtin_scene(arguments.name);
  if (scene) return print(scene->text);
  say(fmt::format("{}: there is no built-in scene of this name; 'clothlab-cli scenes' lists them",
                  arguments.name));
  return bad_input;
}

int scenes(const ScenesArguments& arguments) {
  if (!arguments.name.empty()) return print_one(arguments);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const cloth::BuiltinScene& scene : cloth::builtin_scenes()) {
    list.push_back({{"name", scene.name}, {"title", scene.title}});
    text += fmt::format("{:<20} {}\n", scene.name, scene.title);
  }
  return print(arguments.json ? nlohmann::ordered_json{{"scenes", list}}.dump(2) + "\n" : text);
}

}  // namespace

void add_scenes(Program& program) {
  auto [command, arguments] =
      add_command(program, "scenes", "List the built-in scenes, or print one", scenes);
  command.add_option("name", arguments.name, "The scene to print");
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
