// Shaders from the resources, compiled into a program.
#pragma once

#include <QByteArray>
#include <QOpenGLShaderProgram>

namespace clothlab {

/// What goes before the shaders' own files.
struct ShaderPrelude {
  enum class Light { nowhere, fragment, vertex };
  Light light = Light::nowhere;  ///< which of the two has light.glsl
  QByteArray definitions{};      ///< lines of #define, for both
};

/// Compiles resources/shaders/`vertex` and `fragment`, each as GLSL 3.30. On failure false, with the
/// compiler's message in `problem`.
bool build_program(QOpenGLShaderProgram& program, const char* vertex, const char* fragment,
                   const ShaderPrelude& prelude, QString* problem);

/// A colour in linear light, and as it is (sRGB), for uniforms.
QVector3D linear_light(const QColor& colour);
QVector3D as_srgb(const QColor& colour);

}  // namespace clothlab
