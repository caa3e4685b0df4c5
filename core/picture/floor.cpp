#include "picture/floor.h"

#include <algorithm>
#include <cmath>

#include "geometry/round_numbers.h"

namespace cloth {
namespace {

constexpr float slope_opacity = 0.92F;
constexpr double farther = 0.003;  // share of its distance: what lies on the floor is seen whole

float smoothstep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return static_cast<float>(t * t * (3 - 2 * t));
}

/// How much of a pixel that is `per_pixel` lines wide the lines through whole numbers cover.
float line_cover(double place, double per_pixel) {
  const double to_line = std::abs(place - std::round(place)) / std::max(per_pixel, 1e-9);
  const float sharp = 1 - smoothstep(0, 1, to_line);
  const float melted = smoothstep(0.15, 0.4, per_pixel);  // lines closer than a few pixels become their mean
  return (1 - melted) * sharp + melted * static_cast<float>(std::min(per_pixel, 1.0));
}

struct Paint {
  Colour colour;
  float opacity = 0;
};

Paint floor_paint(const Floor& floor, const Vec3& at, const Vec3& right, const Vec3& below) {
  const Vec3 from_middle = at - floor.middle;
  Paint paint;
  const float fade = 1 - smoothstep(floor.is_level() ? 0.25 : 0.55, 1, from_middle.norm() / floor.reach);
  if (!(fade > 0)) return paint;
  float fine = 0, coarse = 0;
  for (const Vec3& axis : {floor.axis_u, floor.axis_v}) {
    const double place = at.dot(axis) / floor.grid_step;
    const double per_pixel = std::max(std::abs(right.dot(axis)), std::abs(below.dot(axis))) / floor.grid_step;
    fine = std::max(fine, line_cover(place, per_pixel));
    coarse = std::max(coarse, line_cover(place / 5, per_pixel / 5));
  }
  const float line = floor.line_opacity * std::max(0.55F * fine, coarse);
  const float dark = floor.shadow == nullptr ? 0 : floor.shade_opacity * floor.shadow->at(at.x(), at.z());
  // Floor, then lines, then shadow, one over the other.
  const float rest = (1 - floor.ground_opacity) * (1 - line) * (1 - dark);
  paint.colour = (1 - dark) * ((1 - line) * floor.ground_opacity * floor.ground + line * floor.line) +
                 dark * floor.shade;
  paint.opacity = fade * (1 - rest);
  paint.colour /= std::max(1 - rest, 1e-6F);
  return paint;
}

}  // namespace

FloorShadow::FloorShadow(double height, const Vec3& towards_light, const Eigen::AlignedBox3d& bounds)
    : height_(height), light_(towards_light) {
  if (bounds.isEmpty()) return;
  const auto on_floor = [&](const Vec3& p) -> Vec3 { return p - (p.y() - height_) / light_.y() * light_; };
  Eigen::AlignedBox3d cast;
  for (int corner = 0; corner < 8; ++corner)
    cast.extend(on_floor(bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
  const double width = std::max({cast.sizes().x(), cast.sizes().z(), 1e-6});
  texel_ = 1.4 * width / size_;
  left_ = cast.center().x() - 0.7 * width;
  back_ = cast.center().z() - 0.7 * width;
  fade_height_ = std::max(bounds.diagonal().norm(), 1e-6);
  cover_.assign(static_cast<std::size_t>(size_) * size_, 0.0F);
}

void FloorShadow::add(std::span<const PictureVertex> vertices, std::span<const int> triangles) {
  if (cover_.empty()) return;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    std::array<Vec3, 3> corner;
    bool usable = true;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = vertices[static_cast<std::size_t>(triangles[t + k])].position;
      usable = usable && corner[k].allFinite() && corner[k].y() >= height_ - 0.01 * fade_height_;
    }
    if (usable) add_triangle(corner);
  }
}

void FloorShadow::add_triangle(const std::array<Vec3, 3>& corners) {
  std::array<Eigen::Vector2d, 3> p;
  double height = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double above = corners[k].y() - height_;
    p[k] = {(corners[k].x() - above / light_.y() * light_.x() - left_) / texel_,
            (corners[k].z() - above / light_.y() * light_.z() - back_) / texel_};
    height += above / 3;
  }
  // The higher a thing hangs, the fainter its shadow.
  const auto strength = static_cast<float>(std::exp(-std::max(height, 0.0) / (0.7 * fade_height_)));
  const auto texel = [](double at) { return static_cast<int>(std::clamp(std::floor(at), 0.0, size_ - 1.0)); };
  const Eigen::Vector2d ab = p[1] - p[0], ac = p[2] - p[0];
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(std::abs(area) > 1e-9)) return;
  for (int y = texel(std::min({p[0].y(), p[1].y(), p[2].y()}));
       y <= texel(std::max({p[0].y(), p[1].y(), p[2].y()})); ++y) {
    for (int x = texel(std::min({p[0].x(), p[1].x(), p[2].x()}));
         x <= texel(std::max({p[0].x(), p[1].x(), p[2].x()})); ++x) {
      const Eigen::Vector2d d = Eigen::Vector2d(x + 0.5, y + 0.5) - p[0];
      const double b = (d.x() * ac.y() - d.y() * ac.x()) / area, c = (ab.x() * d.y() - ab.y() * d.x()) / area;
      if (b < 0 || c < 0 || b + c > 1) continue;
      float& cover = cover_[static_cast<std::size_t>(y * size_ + x)];
      cover = std::max(cover, strength);
    }
  }
}

void FloorShadow::blur() {
  constexpr int radius = 7, passes = 3;  // three boxes are nearly a bell
  std::vector<float> line(size_);
  for (int pass = 0; pass < 2 * passes && !cover_.empty(); ++pass) {
    const int stride = pass % 2 == 0 ? 1 : size_, next = pass % 2 == 0 ? size_ : 1;
    for (int k = 0; k < size_; ++k) {
      float* first = cover_.data() + k * next;
      for (int i = 0; i < size_; ++i) line[static_cast<std::size_t>(i)] = first[i * stride];
      for (int i = 0; i < size_; ++i) {
        float sum = 0;
        for (int j = std::max(i - radius, 0); j <= std::min(i + radius, size_ - 1); ++j)
          sum += line[static_cast<std::size_t>(j)];
        first[i * stride] = sum / (2 * radius + 1);
      }
    }
  }
}

float FloorShadow::at(double x, double z) const {
  if (cover_.empty()) return 0;
  const double u = (x - left_) / texel_ - 0.5, v = (z - back_) / texel_ - 0.5;
  if (!(u >= 0 && v >= 0 && u < size_ - 1 && v < size_ - 1)) return 0;
  const auto i = static_cast<std::size_t>(u), k = static_cast<std::size_t>(v);
  const auto s = static_cast<float>(u - static_cast<double>(i)),
             t = static_cast<float>(v - static_cast<double>(k));
  const float* texel = cover_.data() + k * size_ + i;
  return (1 - t) * ((1 - s) * texel[0] + s * texel[1]) + t * ((1 - s) * texel[size_] + s * texel[size_ + 1]);
}

Floor::Floor(const Vec3& on_plane, const Vec3& unit_normal, const Eigen::AlignedBox3d& extent,
             const PictureTheme& theme)
    : point(on_plane), normal(unit_normal) {
  const Vec3 about = extent.isEmpty() ? point : Vec3(extent.center());
  const double size = extent.isEmpty() ? 1 : std::max(extent.diagonal().norm(), 1e-6);
  // Along x and z on level ground; the other planes take the nearest such pair.
  const Vec3 hint = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
  axis_u = (hint - hint.dot(normal) * normal).normalized();
  axis_v = normal.cross(axis_u);
  middle = about - (about - point).dot(normal) * normal;
  reach = (is_level() ? 2.2 : 1.3) * size;
  grid_step = grid_step_for(size);
  ground = linear_light(is_level() ? theme.floor : theme.slope);
  line = linear_light(theme.floor_line);
  shade = linear_light(theme.floor_shadow);
  ground_opacity = is_level() ? theme.floor_opacity : slope_opacity;
  line_opacity = theme.line_opacity;
  shade_opacity = theme.shadow_opacity;
}

void lay_floor(const Floor& floor, const EyeFrame& frame, SampleBand& band) {
  const double above = floor.normal.dot(floor.point - frame.eye);
  if (!(std::abs(above) > 1e-9)) return;  // seen from the edge
  constexpr int n = SampleBand::per_pixel;
  const auto nearness_at = [&](double x, double y) { return floor.normal.dot(frame.ray(x, y)) / above; };
  const auto point_at = [&](double x, double y, double nearness) -> Vec3 {
    return frame.eye + frame.ray(x, y) / nearness;
  };
  for (int y = band.first_row; y < band.last_row; ++y) {
    for (int x = 0; x < band.width; ++x) {
      const double cx = x + 0.5, cy = y + 0.5, near_c = nearness_at(cx, cy);
      const double near_x = nearness_at(cx + 1, cy), near_y = nearness_at(cx, cy + 1);
      if (!(std::min({near_c, near_x, near_y}) > 1e-6) || near_c > 1 / frame.near) continue;
      const Vec3 at = point_at(cx, cy, near_c);
      const Paint paint =
          floor_paint(floor, at, point_at(cx + 1, cy, near_x) - at, point_at(cx, cy + 1, near_y) - at);
      if (paint.opacity < 1e-3F) continue;
      for (int sy = n * y; sy < n * (y + 1); ++sy) {
        for (int sx = n * x; sx < n * (x + 1); ++sx) {
          const std::size_t k = band.index(sx, sy);
          const double nearness = nearness_at((sx + 0.5) / n, (sy + 0.5) / n) * (1 - farther);
          if (static_cast<float>(nearness) <= band.nearness[k]) continue;
          band.colour[k] += paint.opacity * (paint.colour - band.colour[k]);
          if (!floor.is_level() && paint.opacity > 0.5F) band.nearness[k] = static_cast<float>(nearness);
        }
      }
    }
  }
}

}  // namespace cloth
