// Obstacles that are surfaces in the graphics memory: uploaded once for each mesh, placed by the shader.
#pragma once

#include <QOpenGLFunctions_3_3_Core>
#include <map>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace clothlab {

/// A context must be current whenever a member is called, the destructor included.
class MeshBodies {
 public:
  explicit MeshBodies(QOpenGLFunctions_3_3_Core& gl) : gl_(gl) {}
  ~MeshBodies();
  MeshBodies(const MeshBodies&) = delete;
  MeshBodies& operator=(const MeshBodies&) = delete;

  /// Uploads the meshes of these obstacles that are not there yet, and deletes those that no obstacle uses
  /// any more.
  void keep(const std::vector<cloth::Obstacle>& obstacles);
  void draw(const cloth::TriangleMesh& mesh);  ///< before it is placed; one of those that are kept

 private:
  struct Body {
    std::shared_ptr<const cloth::TriangleMesh> mesh;  ///< so that its address is not given to another
    GLuint vertex_array = 0, vertices = 0;
    GLsizei count = 0;
  };
  Body upload(std::shared_ptr<const cloth::TriangleMesh> mesh);
  void release(const Body& body);

  QOpenGLFunctions_3_3_Core& gl_;
  std::map<const cloth::TriangleMesh*, Body> bodies_;
};

}  // namespace clothlab
