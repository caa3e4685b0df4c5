// The programs and textures that all renderers of a context draw with. They take a tenth of a second to make,
// once for each context.
#pragma once

#include <QImage>
#include <QOpenGLFunctions_3_3_Core>
#include <QOpenGLShaderProgram>
#include <array>
#include <memory>
#include <vector>

namespace clothlab {

/// The context must be current when a kit is made and when its last owner releases it.
class RendererKit : protected QOpenGLFunctions_3_3_Core {
 public:
  enum Texture { weave, palette, stored_weave, stored_palette, texture_count };

  /// That of the current context (OpenGL 3.3 core or later). None: `problem` says why. `frugal`: with what a
  /// processor draws quickly.
  static std::shared_ptr<RendererKit> of_the_context(bool frugal, QString* problem);

  ~RendererKit();
  RendererKit(const RendererKit&) = delete;
  RendererKit& operator=(const RendererKit&) = delete;

  bool frugal() const { return frugal_; }

  QOpenGLShaderProgram background, plane, shadow, solid, marker, thread, contact_box, contact_line;
  std::array<QOpenGLShaderProgram, 3> cloth, quick_cloth;  ///< by ViewMode; quick_cloth only if frugal
  GLuint textures[texture_count] = {};                     ///< the stored ones give sRGB; only if frugal

 private:
  explicit RendererKit(bool frugal) : frugal_(frugal) {}

  bool build_programs(QString* problem);
  void make_textures();
  void give(Texture texture, GLint format, const std::vector<QImage>& levels);

  bool frugal_;
};

}  // namespace clothlab
