#include "viewport/gl/shader_program.h"

#include <QColor>
#include <QFile>
#include <QVector3D>
#include <cmath>

namespace clothlab {
namespace {

QByteArray shader_text(const char* name) {
  QFile file(QStringLiteral(":/clothlab/shaders/") + QLatin1String(name));
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

}  // namespace

bool build_program(QOpenGLShaderProgram& program, const char* vertex, const char* fragment,
                   const ShaderPrelude& prelude, QString* problem) {
  const auto text_of = [&prelude](const char* name, ShaderPrelude::Light stage) {
    const QByteArray light = prelude.light == stage ? shader_text("light.glsl") : QByteArray();
    return "#version 330 core\n" + prelude.definitions + light + "#line 1\n" + shader_text(name);
  };
  using Light = ShaderPrelude::Light;
  const bool built =
      program.addShaderFromSourceCode(QOpenGLShader::Vertex, text_of(vertex, Light::vertex)) &&
      program.addShaderFromSourceCode(QOpenGLShader::Fragment, text_of(fragment, Light::fragment)) &&
      program.link();
  if (!built) *problem = QStringLiteral("%1, %2: %3").arg(vertex, fragment, program.log().trimmed());
  return built;
}

QVector3D as_srgb(const QColor& colour) {
  return {colour.redF(), colour.greenF(), colour.blueF()};
}

QVector3D linear_light(const QColor& colour) {
  const auto decode = [](float x) {
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
  };
  return {decode(colour.redF()), decode(colour.greenF()), decode(colour.blueF())};
}

}  // namespace clothlab
