#include "io/tiny_obj.h"

#include <fmt/format.h>

#include <iterator>

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace cloth {

std::vector<Triangle> cut_into_triangles(const std::vector<Vec3>& vertices, const std::string& faces) {
  std::string text;
  for (const Vec3& v : vertices)
    fmt::format_to(std::back_inserter(text), "v {} {} {}\n", v.x(), v.y(), v.z());
  text += faces;
  tinyobj::ObjReader reader;
  tinyobj::ObjReaderConfig config;
  config.vertex_color = false;
  std::vector<Triangle> triangles;
  if (!reader.ParseFromString(text, "", config)) return triangles;
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    for (std::size_t k = 0; k + 2 < shape.mesh.indices.size(); k += 3)
      triangles.push_back({shape.mesh.indices[k].vertex_index, shape.mesh.indices[k + 1].vertex_index,
                           shape.mesh.indices[k + 2].vertex_index});
  return triangles;
}

}  // namespace cloth
