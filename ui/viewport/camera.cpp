#include "viewport/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clothlab {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radians_per_pixel = 0.006;
constexpr double least_distance = 1e-3, max_distance = 1e4;  // m
constexpr double air = 1.12;                                 // of a framed box's size

/// The eye's axes for a yaw and pitch, as columns: right, up, backward. Written out rather than found by a
/// cross product with y, so that straight down is an orientation like any other.
Eigen::Matrix3d axes(double yaw, double pitch) {
  const double sy = std::sin(yaw), cy = std::cos(yaw), sp = std::sin(pitch), cp = std::cos(pitch);
  Eigen::Matrix3d columns;
  columns.col(0) << cy, 0, -sy;
  columns.col(1) << -sy * sp, cp, -cy * sp;
  columns.col(2) << sy * cp, sp, cy * cp;
  return columns;
}

/// The same direction, within half a turn of `near`.
double turned_near(double angle, double near) {
  return near + std::remainder(angle - near, 2 * pi);
}

}  // namespace

void Camera::set_viewport(double width, double height) {
  width_ = std::max(width, 1.0);
  height_ = std::max(height, 1.0);
}

void Camera::set_pose(const CameraPose& pose) {
  pose_ = pose;
  pose_.distance = std::clamp(pose.distance, least_distance, max_distance);
  pose_.pitch = std::clamp(pose.pitch, -pi / 2, pi / 2);
}

void Camera::orbit(double pixels_right, double pixels_down) {
  CameraPose pose = pose_;
  pose.yaw -= radians_per_pixel * pixels_right;
  pose.pitch += radians_per_pixel * pixels_down;
  set_pose(pose);
}

void Camera::pan(double pixels_right, double pixels_down) {
  pose_.target += metres_per_pixel() * (-pixels_right * right() + pixels_down * up());
}

void Camera::zoom(double factor, const Eigen::Vector2d& cursor) {
  const Eigen::Vector3d under_cursor = on_screen_plane(cursor, pose_.target);
  CameraPose pose = pose_;
  pose.distance = std::clamp(pose_.distance / factor, least_distance, max_distance);
  const double shrink = pose.distance / pose_.distance;
  pose.target = under_cursor + shrink * (pose_.target - under_cursor);
  set_pose(pose);
}

CameraPose Camera::framed(const Eigen::AlignedBox3d& box, const CameraPose& from) const {
  CameraPose pose = from;
  if (box.isEmpty()) return pose;
  pose.target = box.center();
  const double slope_y = std::tan(field_of_view / 2), slope_x = slope_y * width_ / height_;
  const Eigen::Matrix3d to_eye = axes(from.yaw, from.pitch).transpose();
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const Eigen::Vector3d d = air * (to_eye * (box.corner(type) - pose.target));
    distance = std::max({distance, d.z() + std::abs(d.x()) / slope_x, d.z() + std::abs(d.y()) / slope_y});
  }
  pose.distance = std::clamp(distance, 0.05, max_distance);
  return pose;
}

CameraPose Camera::seen_from(CameraPreset preset) const {
  CameraPose pose = pose_;
  const auto turn = [&pose](double yaw, double pitch) {
    pose.yaw = turned_near(yaw, pose.yaw);
    pose.pitch = pitch;
  };
  switch (preset) {
    case CameraPreset::front:
      turn(0, 0);
      break;
    case CameraPreset::back:
      turn(pi, 0);
      break;
    case CameraPreset::left:
      turn(-pi / 2, 0);
      break;
    case CameraPreset::right:
      turn(pi / 2, 0);
      break;
    case CameraPreset::top:
      turn(0, pi / 2);
      break;
    case CameraPreset::isometric:
      turn(pi / 4, std::atan(1 / std::numbers::sqrt2));
      break;
  }
  return pose;
}

Eigen::Vector3d Camera::right() const {
  return axes(pose_.yaw, pose_.pitch).col(0);
}
Eigen::Vector3d Camera::up() const {
  return axes(pose_.yaw, pose_.pitch).col(1);
}
Eigen::Vector3d Camera::forward() const {
  return -axes(pose_.yaw, pose_.pitch).col(2);
}
Eigen::Matrix4d Camera::view() const {
  const Eigen::Matrix3d to_eye = axes(pose_.yaw, pose_.pitch).transpose();
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = to_eye;
  m.topRightCorner<3, 1>() = -to_eye * eye();
  return m;
}

Eigen::Matrix4d Camera::projection() const {
  const double near = 0.02 * pose_.distance, far = 60 * pose_.distance;
  const double scale = 1 / std::tan(field_of_view / 2);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = scale * height_ / width_;
  m(1, 1) = scale;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2 * far * near / (near - far);
  m(3, 2) = -1;
  return m;
}

Eigen::Matrix4d Camera::world_to_screen() const {
  Eigen::Matrix4d to_pixels = Eigen::Matrix4d::Identity();
  to_pixels(0, 0) = to_pixels(0, 3) = width_ / 2;
  to_pixels(1, 1) = -height_ / 2;
  to_pixels(1, 3) = height_ / 2;
  return to_pixels * projection() * view();
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& point) const {
  return (world_to_screen() * point.homogeneous()).eval().hnormalized().head<2>();
}

Ray Camera::ray(const Eigen::Vector2d& pixel) const {
  const double slope = std::tan(field_of_view / 2);
  const double x = (2 * pixel.x() - width_) / height_ * slope, y = (1 - 2 * pixel.y() / height_) * slope;
  return {eye(), (forward() + x * right() + y * up()).normalized()};
}

Eigen::Vector3d Camera::on_screen_plane(const Eigen::Vector2d& pixel, const Eigen::Vector3d& point) const {
  const Ray through = ray(pixel);
  const Eigen::Vector3d normal = forward();
  const double along = (point - through.origin).dot(normal) / through.direction.dot(normal);
  return through.origin + along * through.direction;
}

double Camera::metres_per_pixel() const {
  return 2 * pose_.distance * std::tan(field_of_view / 2) / height_;
}

void CameraFlight::start(const CameraPose& from, const CameraPose& to) {
  from_ = from;
  to_ = to;
  elapsed_ = 0;
  flying_ = !(from == to);
}

CameraPose CameraFlight::advance(double seconds) {
  elapsed_ = std::min(elapsed_ + seconds, duration);
  flying_ = elapsed_ < duration;
  if (!flying_) return to_;
  const double t = elapsed_ / duration, s = t * t * (3 - 2 * t);
  CameraPose pose;
  pose.target = from_.target + s * (to_.target - from_.target);
  pose.distance = std::exp(std::lerp(std::log(from_.distance), std::log(to_.distance), s));
  pose.yaw = std::lerp(from_.yaw, to_.yaw, s);
  pose.pitch = std::lerp(from_.pitch, to_.pitch, s);
  return pose;
}

}  // namespace clothlab
