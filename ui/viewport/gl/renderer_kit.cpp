#include "viewport/gl/renderer_kit.h"

#include <QImage>
#include <QOpenGLContext>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "viewport/gl/shader_program.h"
#include "viewport/gl/weave.h"
#include "viewport/strain_scale.h"

namespace clothlab {

std::shared_ptr<RendererKit> RendererKit::of_the_context(bool frugal, QString* problem) {
  static std::map<std::pair<const QOpenGLContext*, bool>, std::weak_ptr<RendererKit>> kits;
  std::erase_if(kits, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<RendererKit>& known = kits[{QOpenGLContext::currentContext(), frugal}];
  if (auto kit = known.lock()) return kit;
  std::shared_ptr<RendererKit> kit(new RendererKit(frugal));
  if (!kit->initializeOpenGLFunctions()) {
    *problem = QStringLiteral("the functions of OpenGL 3.3 are missing");
    return nullptr;
  }
  if (!kit->build_programs(problem)) return nullptr;
  kit->make_textures();
  known = kit;
  return kit;
}

RendererKit::~RendererKit() {
  if (textures[weave] != 0) glDeleteTextures(texture_count, textures);
}

bool RendererKit::build_programs(QString* problem) {
  using Light = ShaderPrelude::Light;
  for (std::size_t look = 0; look < cloth.size(); ++look) {
    const QByteArray definition = "#define LOOK " + QByteArray::number(static_cast<int>(look)) + '\n';
    if (!build_program(cloth[look], "cloth.vert", "cloth.frag", {Light::fragment, definition}, problem))
      return false;
    const QByteArray quick = definition + "#define QUICK\n";
    if (frugal_ &&
        !build_program(quick_cloth[look], "cloth.vert", "cloth.frag", {Light::vertex, quick}, problem))
      return false;
  }
  return build_program(background, "background.vert", "background.frag", {}, problem) &&
         build_program(plane, "plane.vert", "plane.frag", {}, problem) &&
         build_program(shadow, "shadow.vert", "shadow.frag", {}, problem) &&
         build_program(solid, "solid.vert", "solid.frag", {Light::fragment}, problem) &&
         build_program(marker, "marker.vert", "marker.frag", {}, problem) &&
         build_program(thread, "thread.vert", "thread.frag", {}, problem) &&
         build_program(contact_box, "contact_box.vert", "contact_line.frag", {}, problem) &&
         build_program(contact_line, "contact_line.vert", "contact_line.frag", {}, problem);
}

void RendererKit::make_textures() {
  glGenTextures(texture_count, textures);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  give(weave, GL_SRGB8_ALPHA8, shared_weave());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  // The extension's numbers: OpenGL 3.3's own headers do not have them (core since 4.6).
  constexpr GLenum texture_max_anisotropy = 0x84FE, max_texture_max_anisotropy = 0x84FF;
  if (!frugal_ && QOpenGLContext::currentContext()->hasExtension("GL_EXT_texture_filter_anisotropic")) {
    GLfloat most = 1;
    glGetFloatv(max_texture_max_anisotropy, &most);
    glTexParameterf(GL_TEXTURE_2D, texture_max_anisotropy, std::min(most, 8.0F));
  }

  QImage colours(strain_colour_count, 1, QImage::Format_RGBA8888);
  for (int i = 0; i < strain_colour_count; ++i)
    colours.setPixelColor(i, 0, strain_colours()[static_cast<std::size_t>(i)]);
  give(palette, GL_SRGB8_ALPHA8, {colours});
  if (frugal_) {
    give(stored_weave, GL_RGBA8, shared_weave());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);  // half the work
    give(stored_palette, GL_RGBA8, {colours});
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // 256 colours are smooth enough
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
}

/// Its mipmaps are given too: a processor that draws compiles a program for each that it makes itself. Leaves
/// the texture bound. One without mipmaps does not repeat.
void RendererKit::give(Texture texture, GLint format, const std::vector<QImage>& levels) {
  glBindTexture(GL_TEXTURE_2D, textures[texture]);
  for (std::size_t i = 0; i < levels.size(); ++i)
    glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(i), format, levels[i].width(), levels[i].height(), 0,
                 GL_RGBA, GL_UNSIGNED_BYTE, levels[i].constBits());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  if (levels.size() == 1) glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
}

}  // namespace clothlab
