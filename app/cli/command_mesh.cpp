#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "geometry/builtin_meshes.h"
#include "io/obj_writer.h"

namespace clothlab::cli {
namespace {

struct MeshArguments {
  std::string name;
};

int mesh(const MeshArguments& arguments) {
  if (arguments.name.empty()) {
    std::string list;
    for (const cloth::BuiltinMesh& mesh : cloth::builtin_meshes())
      list += fmt::format("{:<14} {}\n", mesh.name, mesh.title);
    return print(list);
  }
  const cloth::BuiltinMesh* found = cloth::find_builtin_mesh(arguments.name);
  if (!found) {
    say(fmt::format("{}: there is no built-in mesh of this name; 'clothlab-cli mesh' lists them",
                    arguments.name));
    return bad_input;
  }
  return print(cloth::obj_text(found->make(), found->title));
}

}  // namespace

void add_mesh(Program& program) {
  auto [command, arguments] =
      add_command(program, "mesh", "List the built-in meshes, or print one as an OBJ file", mesh);
  command.add_option("name", arguments.name, "The mesh to print");
}

}  // namespace clothlab::cli
