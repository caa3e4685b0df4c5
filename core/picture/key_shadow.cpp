#include "picture/key_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {

KeyShadow::KeyShadow(const Vec3& towards_light, const Eigen::AlignedBox3d& bounds) : towards_(towards_light) {
  const double size = bounds.isEmpty() ? 0 : bounds.diagonal().norm();
  if (!(size > 0) || !std::isfinite(size)) return;
  right_ = (std::abs(towards_.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX()).cross(towards_).normalized();
  up_ = towards_.cross(right_);
  middle_ = bounds.center();
  texel_ = 1.05 * size / size_;
  slack_ = 0.016 * size;
  nearest_.assign(static_cast<std::size_t>(size_) * size_, -std::numeric_limits<float>::infinity());
}

Vec3 KeyShadow::in_light(const Vec3& point) const {
  const Vec3 d = point - middle_;
  return {d.dot(right_) / texel_ + size_ / 2, d.dot(up_) / texel_ + size_ / 2, d.dot(towards_)};
}

void KeyShadow::add_triangle(const std::array<Vec3, 3>& corners) {
  if (nearest_.empty()) return;
  std::array<Vec3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = in_light(corners[k]);
  const Vec3 ab = p[1] - p[0], ac = p[2] - p[0];
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(std::abs(area) > 1e-9)) return;
  const auto texel = [](double at) { return static_cast<int>(std::clamp(std::floor(at), 0.0, size_ - 1.0)); };
  const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  for (int y = texel(low_y); y <= texel(high_y); ++y) {
    for (int x = texel(low_x); x <= texel(high_x); ++x) {
      const Vec3 d = Vec3(x + 0.5, y + 0.5, 0) - p[0];
      const double b = (d.x() * ac.y() - d.y() * ac.x()) / area, c = (ab.x() * d.y() - ab.y() * d.x()) / area;
      if (b < 0 || c < 0 || b + c > 1) continue;
      float& nearest = nearest_[static_cast<std::size_t>(y * size_ + x)];
      nearest = std::max(nearest, static_cast<float>(p[0].z() + b * ab.z() + c * ac.z()));
    }
  }
}

float KeyShadow::at(const Eigen::Vector3f& point) const {
  if (nearest_.empty()) return 0;
  const Vec3 p = in_light(point.cast<double>());
  if (!(p.x() >= soft_ + 1 && p.y() >= soft_ + 1 && p.x() < size_ - soft_ - 1 && p.y() < size_ - soft_ - 1))
    return 0;
  // A window that moves with the point, its first and last texels counted in part, and a height within which
  // the shadow sets in: so neither texels nor heights show as steps.
  const double left = p.x() - 0.5 - soft_, top = p.y() - 0.5 - soft_;
  const int x = static_cast<int>(std::ceil(left)), y = static_cast<int>(std::ceil(top));
  const auto part_x = static_cast<float>(x - left), part_y = static_cast<float>(y - top);
  const auto own = static_cast<float>(p.z() + slack_), sets_in = static_cast<float>(0.5 * slack_);
  float hidden = 0;
  for (int j = 0; j <= 2 * soft_; ++j) {
    const float weight_y = j == 0 ? part_y : j == 2 * soft_ ? 1 - part_y : 1;
    const float* row = nearest_.data() + (y + j) * size_ + x;
    float sum = 0;
    for (int i = 0; i <= 2 * soft_; ++i) {
      const float weight_x = i == 0 ? part_x : i == 2 * soft_ ? 1 - part_x : 1;
      sum += weight_x * std::clamp((row[i] - own) / sets_in, 0.0F, 1.0F);
    }
    hidden += weight_y * sum;
  }
  return hidden / (4 * soft_ * soft_);
}

}  // namespace cloth
