#include "viewport/gl/gl_probe.h"

#include <QCoreApplication>
#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QStringList>
#include <QSurfaceFormat>

namespace clothlab {
namespace {

QString words(const char* text) {
  return QCoreApplication::translate("ClothView", text);
}

/// These platforms may give a context that works and yet never show what it draws: widgets drawn by OpenGL
/// crash there.
bool platform_shows_no_opengl() {
  return QStringList{"offscreen", "minimal", "vnc", "linuxfb"}.contains(QGuiApplication::platformName());
}

GlAbilities probe() {
  GlAbilities found;
  if (platform_shows_no_opengl()) {
    found.problem = words("This display offers no OpenGL.");
    return found;
  }
  QSurfaceFormat wanted;
  wanted.setRenderableType(QSurfaceFormat::OpenGL);
  wanted.setVersion(3, 3);
  wanted.setProfile(QSurfaceFormat::CoreProfile);

  QOpenGLContext context;
  context.setFormat(wanted);
  QOffscreenSurface surface;
  surface.setFormat(wanted);
  surface.create();
  if (!context.create() || !surface.isValid() || !context.makeCurrent(&surface)) {
    found.problem = words("This display offers no OpenGL.");
    return found;
  }
  const auto text = [&context](GLenum name) {
    return QString::fromLatin1(reinterpret_cast<const char*>(context.functions()->glGetString(name)));
  };
  found.renderer = text(GL_RENDERER);
  found.version = text(GL_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "SWR", "SwiftShader", "Software"})
    found.software = found.software || found.renderer.contains(QLatin1String(name), Qt::CaseInsensitive);
  const std::pair<int, int> version = context.format().version();
  found.usable = !context.isOpenGLES() && version >= std::pair(3, 3);
  if (!found.usable)
    found.problem = words("This display offers %1; the view needs OpenGL 3.3.").arg(found.version);
  context.doneCurrent();
  return found;
}

}  // namespace

const GlAbilities& gl_abilities() {
  static const GlAbilities abilities = probe();
  return abilities;
}

}  // namespace clothlab
