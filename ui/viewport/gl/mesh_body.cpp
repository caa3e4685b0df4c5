#include "viewport/gl/mesh_body.h"

#include "geometry/mesh_look.h"
#include "scene/obstacle_shape.h"
#include "viewport/gl/solids.h"

namespace clothlab {

MeshBodies::~MeshBodies() {
  for (const auto& [mesh, body] : bodies_) release(body);
}

void MeshBodies::keep(const std::vector<cloth::Obstacle>& obstacles) {
  std::map<const cloth::TriangleMesh*, std::shared_ptr<const cloth::TriangleMesh>> shown;
  for (const cloth::Obstacle& o : obstacles)
    if (const auto mesh = shape_of(o).surface(o).mesh) shown.emplace(mesh.get(), mesh);
  for (auto body = bodies_.begin(); body != bodies_.end();) {
    if (shown.count(body->first)) {
      ++body;
      continue;
    }
    release(body->second);
    body = bodies_.erase(body);
  }
  for (const auto& [key, mesh] : shown)
    if (!bodies_.count(key)) bodies_.emplace(key, upload(mesh));
}

MeshBodies::Body MeshBodies::upload(std::shared_ptr<const cloth::TriangleMesh> mesh) {
  const cloth::TriangleMesh& surface = *mesh;
  const std::vector<cloth::Vec3> normals = cloth::corner_normals(surface);
  std::vector<float> values;  // position and normal of each corner
  values.reserve(6 * normals.size());
  for (std::size_t k = 0; k < normals.size(); ++k) {
    const cloth::Vec3& position = surface.vertices[static_cast<std::size_t>(surface.triangles[k / 3][k % 3])];
    for (const cloth::Vec3* vector : {&position, &normals[k]})
      for (const double component : *vector) values.push_back(static_cast<float>(component));
  }
  Body body{std::move(mesh), 0, 0, static_cast<GLsizei>(normals.size())};
  gl_.glGenVertexArrays(1, &body.vertex_array);
  gl_.glGenBuffers(1, &body.vertices);
  upload_corners(gl_, body.vertex_array, body.vertices, values);
  gl_.glBindVertexArray(0);
  return body;
}

void MeshBodies::release(const Body& body) {
  gl_.glDeleteVertexArrays(1, &body.vertex_array);
  gl_.glDeleteBuffers(1, &body.vertices);
}

void MeshBodies::draw(const cloth::TriangleMesh& mesh) {
  const auto found = bodies_.find(&mesh);
  if (found == bodies_.end()) return;
  gl_.glBindVertexArray(found->second.vertex_array);
  gl_.glDrawArrays(GL_TRIANGLES, 0, found->second.count);
  gl_.glBindVertexArray(0);
}

}  // namespace clothlab
