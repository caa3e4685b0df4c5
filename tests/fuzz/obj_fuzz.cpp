// The reader of OBJ files: triangles between the vertices that it read, or a problem.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "geometry/mesh_repair.h"
#include "io/obj_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const cloth::ObjReading reading = cloth::parse_obj(text, "x.obj");
  if (reading.mesh.has_value() == !reading.problem.empty()) std::abort();
  if (!reading.mesh) return 0;
  const cloth::TriangleMesh& mesh = *reading.mesh;
  for (const cloth::Vec3& vertex : mesh.vertices)
    if (!vertex.allFinite()) std::abort();
  for (const cloth::Triangle& triangle : mesh.triangles)
    for (const int corner : triangle)
      if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.vertices.size()) std::abort();
  cloth::inspect(cloth::weld(mesh, 0).mesh);
  return 0;
}
