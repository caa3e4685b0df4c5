// Draws contact over the picture: contact points as dots with their normals, and boxes of bounding volume
// hierarchies.
#pragma once

#include <Eigen/Core>
#include <QOpenGLFunctions_3_3_Core>

#include "bridge/frame.h"

class QOpenGLShaderProgram;

namespace clothlab {

class RendererKit;
struct Theme;

/// A context must be current whenever a member is called, the destructor included.
class ContactLayer {
 public:
  explicit ContactLayer(QOpenGLFunctions_3_3_Core& gl);
  ~ContactLayer();
  ContactLayer(const ContactLayer&) = delete;
  ContactLayer& operator=(const ContactLayer&) = delete;

  void upload(const ClothFrame& frame);

  struct View {
    Eigen::Matrix4d world_to_clip;
    double metres_per_pixel, pixel_ratio;
    double cell;  ///< px, of the cloth, where the eye looks: marks of neighbours stay apart
  };
  /// What lies behind something is drawn faintly. Depth is tested and not written, and colours are blended.
  void draw(RendererKit& kit, const View& view, const Theme& theme);

 private:
  struct Pass {
    GLenum depth;
    float opacity;
  };
  void draw_boxes(QOpenGLShaderProgram& program, const View& view, const Theme& theme, const Pass& pass);
  void draw_normals(QOpenGLShaderProgram& program, const View& view, const Theme& theme, const Pass& pass);
  void draw_dots(QOpenGLShaderProgram& program, const View& view, const Theme& theme);
  void use_box_buffer(int first);

  QOpenGLFunctions_3_3_Core& gl_;
  GLuint dot_array_ = 0, line_array_ = 0, box_array_ = 0;
  GLuint marks_ = 0, boxes_ = 0;
  GLsizei mark_count_ = 0;
  std::vector<ContactPicture::Boxes> groups_;
  std::vector<cloth::Pose> poses_;
};

}  // namespace clothlab
