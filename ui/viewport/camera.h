// The camera of the view, which orbits a target; y is up. It uses no widgets and no OpenGL; units are metres,
// radians and device-independent pixels (x right, y down).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <QPointF>

namespace clothlab {

enum class CameraPreset { front, back, left, right, top, isometric };

/// Camera position: at `distance` from `target`. yaw 0, pitch 0 looks along -z; yaw turns to +x, pitch raises
/// the camera.
struct CameraPose {
  Eigen::Vector3d target{0, 0.5, 0};  ///< m
  double distance = 3;                ///< m
  double yaw = 0.52, pitch = 0.24;    ///< rad
  bool operator==(const CameraPose&) const = default;
};

struct Ray {
  Eigen::Vector3d origin, direction;  ///< m; unit vector
};

class Camera {
 public:
  static constexpr double field_of_view = 0.6;  ///< rad, over the height of the view

  void set_viewport(double width, double height);  ///< px
  const CameraPose& pose() const { return pose_; }
  void set_pose(const CameraPose& pose);

  void orbit(double pixels_right, double pixels_down);
  /// Moves the target so that its plane follows the cursor.
  void pan(double pixels_right, double pixels_down);
  /// Divides the distance by `factor`; what lies under the cursor in the target's plane stays there.
  void zoom(double factor, const Eigen::Vector2d& cursor);

  /// This pose, moved so that all of `box` is visible and fills the picture up to a small margin.
  CameraPose framed(const Eigen::AlignedBox3d& box, const CameraPose& from) const;
  /// The present target and distance, seen from a named side.
  CameraPose seen_from(CameraPreset preset) const;

  Eigen::Vector3d eye() const { return pose_.target - pose_.distance * forward(); }
  Eigen::Vector3d right() const, up() const, forward() const;  ///< unit vectors
  Eigen::Matrix4d view() const;
  Eigen::Matrix4d projection() const;       ///< OpenGL's clip space
  Eigen::Matrix4d world_to_screen() const;  ///< homogeneous, to px

  Eigen::Vector2d project(const Eigen::Vector3d& point) const;  ///< px
  Ray ray(const Eigen::Vector2d& pixel) const;
  /// The point under `pixel` in the plane through `point` parallel to the screen.
  Eigen::Vector3d on_screen_plane(const Eigen::Vector2d& pixel, const Eigen::Vector3d& point) const;
  double metres_per_pixel() const;  ///< in the target's plane

 private:
  CameraPose pose_;
  double width_ = 1, height_ = 1;  ///< px
};

/// Places in the view, in px: Qt's points and the camera's vectors.
inline Eigen::Vector2d as_vector(QPointF p) {
  return {p.x(), p.y()};
}

inline QPointF as_point(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

/// A short eased animation from one pose to another.
class CameraFlight {
 public:
  static constexpr double duration = 0.35;  ///< s

  void start(const CameraPose& from, const CameraPose& to);
  void stop() { flying_ = false; }
  bool flying() const { return flying_; }
  CameraPose advance(double seconds);

 private:
  CameraPose from_, to_;
  double elapsed_ = 0;  ///< s
  bool flying_ = false;
};

}  // namespace clothlab
