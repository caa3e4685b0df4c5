// Unit sphere and unit box, placed and scaled by the shader.
#pragma once

#include <QOpenGLFunctions_3_3_Core>

namespace clothlab {

/// A context must be current whenever a member is called, the destructor included.
class Solids {
 public:
  explicit Solids(QOpenGLFunctions_3_3_Core& gl);
  ~Solids();
  Solids(const Solids&) = delete;
  Solids& operator=(const Solids&) = delete;

  void draw_sphere();  ///< radius 1
  void draw_box();     ///< edges of length 1, about the origin
  /// Four corners of a strip and a triangle over the whole view: shaders make them from gl_VertexID.
  void draw_strip();
  void draw_screen();

 private:
  QOpenGLFunctions_3_3_Core& gl_;
  GLuint solid_array_ = 0, empty_array_ = 0;
  GLuint vertices_ = 0, indices_ = 0;
  GLsizei sphere_count_ = 0, box_count_ = 0;
};

}  // namespace clothlab
