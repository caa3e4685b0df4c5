// Places in the view, in px: Qt's points and the camera's vectors.
#pragma once

#include <Eigen/Core>
#include <QPointF>

namespace clothlab {

inline Eigen::Vector2d as_vector(QPointF p) {
  return {p.x(), p.y()};
}

inline QPointF as_point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

}  // namespace clothlab
