// Eigen's vectors and matrices as shaders take them.
#pragma once

#include <Eigen/Core>
#include <QGenericMatrix>
#include <QMatrix4x4>
#include <QVector3D>

namespace clothlab {

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
