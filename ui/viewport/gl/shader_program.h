// Shaders from the resources, compiled into a program, and what their uniforms are given.
#pragma once

#include <Eigen/Core>
#include <QByteArray>
#include <QGenericMatrix>
#include <QMatrix4x4>
#include <QOpenGLShaderProgram>
#include <QVector3D>

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

/// Eigen's vectors and matrices as shaders take them.
inline QVector3D uniform_vector(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline QMatrix3x3 uniform_matrix(const Eigen::Matrix3d& m) {
  QMatrix3x3 result;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) result(r, c) = static_cast<float>(m(r, c));
  return result;
}

inline QMatrix4x4 uniform_matrix(const Eigen::Matrix4d& m) {
  QMatrix4x4 result;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) result(r, c) = static_cast<float>(m(r, c));
  return result;
}

}  // namespace clothlab
