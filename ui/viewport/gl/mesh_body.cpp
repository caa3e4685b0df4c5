#include "viewport/gl/mesh_body.h"

#include <algorithm>

#include "geometry/mesh_look.h"

namespace clothlab {

MeshBodies::~MeshBodies() {
  for (const auto& [mesh, body] : bodies_) release(body);
}

void MeshBodies::keep(const std::vector<cloth::Obstacle>& obstacles) {
  const auto is_shown = [&](const cloth::SceneMesh* mesh) {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const cloth::Obstacle& o) {
      return o.shape == cloth::Shape::mesh && o.mesh.loaded.get() == mesh;
    });
  };
  for (auto body = bodies_.begin(); body != bodies_.end();) {
    if (is_shown(body->first)) {
      ++body;
      continue;
    }
    release(body->second);
    body = bodies_.erase(body);
  }
  for (const cloth::Obstacle& o : obstacles)
    if (o.shape == cloth::Shape::mesh && o.mesh.loaded && !bodies_.count(o.mesh.loaded.get()))
      bodies_.emplace(o.mesh.loaded.get(), upload(o.mesh.loaded));
}

MeshBodies::Body MeshBodies::upload(std::shared_ptr<const cloth::SceneMesh> mesh) {
  const cloth::TriangleMesh& surface = mesh->surface;
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
  gl_.glBindVertexArray(body.vertex_array);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, body.vertices);
  gl_.glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                   GL_STATIC_DRAW);
  for (GLuint attribute = 0; attribute < 2; ++attribute) {
    gl_.glEnableVertexAttribArray(attribute);
    gl_.glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                              reinterpret_cast<const void*>(3 * attribute * sizeof(float)));
  }
  gl_.glBindVertexArray(0);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
  return body;
}

void MeshBodies::release(const Body& body) {
  gl_.glDeleteVertexArrays(1, &body.vertex_array);
  gl_.glDeleteBuffers(1, &body.vertices);
}

void MeshBodies::draw(const cloth::SceneMesh& mesh) {
  const auto found = bodies_.find(&mesh);
  if (found == bodies_.end()) return;
  gl_.glBindVertexArray(found->second.vertex_array);
  gl_.glDrawArrays(GL_TRIANGLES, 0, found->second.count);
  gl_.glBindVertexArray(0);
}

}  // namespace clothlab
