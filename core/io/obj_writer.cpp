#include "io/obj_writer.h"

#include <fmt/format.h>

#include <iterator>

namespace cloth {

std::string obj_text(const TriangleMesh& mesh, const std::string& title) {
  std::string text = fmt::format("# {}\n", title);
  for (const Vec3& v : mesh.vertices) fmt::format_to(std::back_inserter(text), "v {} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles)
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

}  // namespace cloth
