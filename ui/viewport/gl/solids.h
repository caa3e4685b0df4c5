// Unit sphere and unit box, placed and scaled by the shader.
#pragma once

#include <QOpenGLFunctions_3_3_Core>
#include <vector>

namespace clothlab {

/// Fills the buffer with positions and normals, six numbers a corner, and lays them out as the attributes 0
/// and 1 of the array, which it leaves bound.
void upload_corners(QOpenGLFunctions_3_3_Core& gl, GLuint array, GLuint buffer,
                    const std::vector<float>& values);

/// A context must be current whenever a member is called, the destructor included.
class Solids {
 public:
  explicit Solids(QOpenGLFunctions_3_3_Core& gl);
  ~Solids();
  Solids(const Solids&) = delete;
  Solids& operator=(const Solids&) = delete;

  void draw_sphere() { draw_solid(0, sphere_count_); }        ///< radius 1
  void draw_box() { draw_solid(sphere_count_, box_count_); }  ///< edges of length 1, about the origin
  /// Four corners of a strip and a triangle over the whole view: shaders make them from gl_VertexID.
  void draw_strip() { draw_made_corners(GL_TRIANGLE_STRIP, 4); }
  void draw_screen() { draw_made_corners(GL_TRIANGLES, 3); }

 private:
  void draw_solid(GLsizei first, GLsizei count);
  void draw_made_corners(GLenum shape, GLsizei count);

  QOpenGLFunctions_3_3_Core& gl_;
  GLuint solid_array_ = 0, empty_array_ = 0;
  GLuint vertices_ = 0, indices_ = 0;
  GLsizei sphere_count_ = 0, box_count_ = 0;
};

}  // namespace clothlab
