#include "picture/rasteriser.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

constexpr int band_rows = 16;
constexpr double farthest = 1e7;      // m: what lies farther away has left the scene
constexpr double least_area = 1e-10;  // px^2, doubled
constexpr double edge_slack = 1e-9;   // of a triangle's height: neighbours leave no crack between them

using Pixel = Eigen::Vector2d;

double cross(const Pixel& a, const Pixel& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool drawable(const Vec3& in_eye) {
  return in_eye.allFinite() && in_eye.cwiseAbs().maxCoeff() < farthest;
}

PictureVertex between(const PictureVertex& a, const PictureVertex& b, double share_of_b) {
  const auto s = static_cast<float>(share_of_b);
  return {(1 - share_of_b) * a.position + share_of_b * b.position, (1 - s) * a.normal + s * b.normal,
          (1 - s) * a.u + s * b.u, (1 - s) * a.v + s * b.v, (1 - s) * a.strain + s * b.strain};
}

/// The samples (first, last + 1) whose middles lie in [low, high] px, cut to [0, count).
std::pair<int, int> sample_range(double low, double high, int first, int count) {
  const auto inside = [&](double px) {
    return static_cast<int>(
        std::ceil(std::clamp(px * SampleBand::per_pixel - 0.5, double(first), double(count))));
  };
  return {inside(low - 1e-6), std::max(inside(low - 1e-6), inside(high + 1e-6))};
}

double middle_of(int sample) {
  return (sample + 0.5) / SampleBand::per_pixel;
}

}  // namespace

int Rasteriser::add_surface(const PictureSurface& surface) {
  surfaces_.push_back(surface);
  return static_cast<int>(surfaces_.size()) - 1;
}

double Rasteriser::nearness_of(double depth, int surface) const {
  return 1 / (std::max(depth, frame_.near) * (1 - surfaces_[static_cast<std::size_t>(surface)].nearer));
}

void Rasteriser::add_mesh(std::span<const PictureVertex> vertices, std::span<const int> triangles,
                          int surface) {
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    std::array<PictureVertex, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = vertices[static_cast<std::size_t>(triangles[t + k])];
    add_triangle(corner, surface);
  }
}

void Rasteriser::add_triangle(const std::array<PictureVertex, 3>& vertices, int surface) {
  // Cut off what lies nearer than the eye can see (Sutherland and Hodgman): up to four corners are left.
  std::array<PictureVertex, 4> cut;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const PictureVertex &a = vertices[k], &b = vertices[(k + 1) % 3];
    const Vec3 a_eye = frame_.to_eye(a.position), b_eye = frame_.to_eye(b.position);
    if (!drawable(a_eye)) return;
    const double from_a = a_eye.z() - frame_.near, from_b = b_eye.z() - frame_.near;
    if (from_a >= 0) cut[count++] = a;
    if ((from_a >= 0) != (from_b >= 0) && drawable(b_eye))
      cut[count++] = between(a, b, from_a / (from_a - from_b));
  }
  const Vec3 own =
      (vertices[1].position - vertices[0].position).cross(vertices[2].position - vertices[0].position);
  const double length = own.norm();
  if (!(length > 0)) return;
  const Eigen::Vector3f own_normal = (own / length).cast<float>();

  for (std::size_t k = 1; k + 1 < count; ++k) {
    Triangle triangle;
    triangle.surface = surface;
    const std::array<const PictureVertex*, 3> corner{&cut[0], &cut[k], &cut[k + 1]};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 in_eye = frame_.to_eye(corner[c]->position);
      const Eigen::Vector3f& n = corner[c]->normal;
      const bool smooth = n.allFinite() && n.squaredNorm() > 0.01F;
      triangle.corner[c] = {frame_.to_pixel(in_eye),
                            nearness_of(in_eye.z(), surface),
                            {corner[c]->position.cast<float>(), smooth ? n : own_normal, corner[c]->u,
                             corner[c]->v, corner[c]->strain, true}};
    }
    const auto& at = triangle.corner;
    // Pixels count downwards, so counter-clockwise in the world is a negative area here.
    const bool front = cross(at[1].pixel - at[0].pixel, at[2].pixel - at[0].pixel) < 0;
    for (Corner& c : triangle.corner) {
      c.seen.front = front;
      if (!front) c.seen.normal = -c.seen.normal;
    }
    triangle.top = std::min({at[0].pixel.y(), at[1].pixel.y(), at[2].pixel.y()});
    triangle.bottom = std::max({at[0].pixel.y(), at[1].pixel.y(), at[2].pixel.y()});
    triangles_.push_back(triangle);
  }
}

void Rasteriser::add_flat(const std::array<Pixel, 3>& pixels, const std::array<double, 3>& nearness,
                          int surface) {
  Triangle triangle;
  triangle.surface = surface;
  for (std::size_t k = 0; k < 3; ++k)
    triangle.corner[k] = {pixels[k], nearness[k], {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()}};
  triangle.top = std::min({pixels[0].y(), pixels[1].y(), pixels[2].y()});
  triangle.bottom = std::max({pixels[0].y(), pixels[1].y(), pixels[2].y()});
  triangles_.push_back(triangle);
}

void Rasteriser::add_line(const Vec3& from, const Vec3& to, double width, int surface) {
  Vec3 a = frame_.to_eye(from), b = frame_.to_eye(to);
  if (!drawable(a) || !drawable(b) || std::max(a.z(), b.z()) <= frame_.near) return;
  if (a.z() < frame_.near) a += (frame_.near - a.z()) / (b.z() - a.z()) * (b - a);
  if (b.z() < frame_.near) b += (frame_.near - b.z()) / (a.z() - b.z()) * (a - b);
  const Pixel p = frame_.to_pixel(a), q = frame_.to_pixel(b);
  const double length = (q - p).norm();
  if (!(length > 1e-9)) return;
  const Pixel along = (q - p) / length, half = 0.5 * width * Pixel(-along.y(), along.x());
  const double at_p = nearness_of(a.z(), surface), at_q = nearness_of(b.z(), surface);
  add_flat({p - half, q - half, q + half}, {at_p, at_q, at_q}, surface);
  add_flat({p - half, q + half, p + half}, {at_p, at_q, at_p}, surface);
}

void Rasteriser::add_arrow(const Vec3& from, const Vec3& to, double width, double head, int surface) {
  const Vec3 a = frame_.to_eye(from), b = frame_.to_eye(to);
  if (!drawable(a) || !drawable(b) || std::min(a.z(), b.z()) <= frame_.near) return;
  const Pixel p = frame_.to_pixel(a), q = frame_.to_pixel(b);
  const double length = (q - p).norm();
  if (!(length > 1e-9)) return;
  const double tip = std::min(head, 0.7 * length);
  const Pixel along = (q - p) / length, side = 0.4 * tip * Pixel(-along.y(), along.x());
  const double nearness = nearness_of(std::min(a.z(), b.z()), surface);
  const Pixel neck = q - tip * along, half = 0.5 * width * Pixel(-along.y(), along.x());
  add_flat({neck - side, q, neck + side}, {nearness, nearness, nearness}, surface);
  add_flat({p - half, neck - half, neck + half}, {nearness, nearness, nearness}, surface);
  add_flat({p - half, neck + half, p + half}, {nearness, nearness, nearness}, surface);
}

void Rasteriser::add_disc(const Vec3& middle, double diameter, int surface) {
  const Vec3 in_eye = frame_.to_eye(middle);
  if (!drawable(in_eye) || in_eye.z() < frame_.near) return;
  discs_.push_back({frame_.to_pixel(in_eye), nearness_of(in_eye.z(), surface), diameter / 2, surface});
}

void Rasteriser::draw_triangle(const Triangle& triangle, SampleBand& band) const {
  const auto& [a, b, c] = triangle.corner;
  const double area = cross(b.pixel - a.pixel, c.pixel - a.pixel);
  if (!(std::abs(area) > least_area)) return;
  constexpr int n = SampleBand::per_pixel;
  const auto [first_x, last_x] =
      sample_range(std::min({a.pixel.x(), b.pixel.x(), c.pixel.x()}),
                   std::max({a.pixel.x(), b.pixel.x(), c.pixel.x()}), 0, band.sample_width());
  const auto [first_y, last_y] =
      sample_range(triangle.top, triangle.bottom, band.first_row * n, band.last_row * n);
  const PictureSurface& surface = surfaces_[static_cast<std::size_t>(triangle.surface)];
  const double step_b = (c.pixel.y() - a.pixel.y()) / area, step_c = -(b.pixel.y() - a.pixel.y()) / area;
  for (int y = first_y; y < last_y; ++y) {
    const Pixel row(-a.pixel.x(), middle_of(y) - a.pixel.y());
    const double row_b = cross(row, c.pixel - a.pixel) / area, row_c = cross(b.pixel - a.pixel, row) / area;
    std::size_t at = band.index(first_x, y);
    for (int x = first_x; x < last_x; ++x, ++at) {
      const double share_b = row_b + middle_of(x) * step_b, share_c = row_c + middle_of(x) * step_c;
      const double share_a = 1 - share_b - share_c;
      if (!(std::min({share_a, share_b, share_c}) >= -edge_slack)) continue;
      const double near_a = share_a * a.nearness, near_b = share_b * b.nearness,
                   near_c = share_c * c.nearness;
      const double nearness = near_a + near_b + near_c;
      if (!(static_cast<float>(nearness) > band.nearness[at])) continue;
      band.nearness[at] = static_cast<float>(nearness);
      if (surface.look == Look::flat) {
        band.colour[at] = surface.front;
        continue;
      }
      const auto s = static_cast<float>(near_b / nearness), t = static_cast<float>(near_c / nearness);
      const float r = 1 - s - t;
      SeenPoint point;
      point.position = r * a.seen.position + s * b.seen.position + t * c.seen.position;
      point.normal = (r * a.seen.normal + s * b.seen.normal + t * c.seen.normal).normalized();
      point.u = r * a.seen.u + s * b.seen.u + t * c.seen.u;
      point.v = r * a.seen.v + s * b.seen.v + t * c.seen.v;
      point.strain = r * a.seen.strain + s * b.seen.strain + t * c.seen.strain;
      point.front = a.seen.front;
      band.colour[at] = light_.shade(surface, point);
    }
  }
}

void Rasteriser::draw_disc(const Disc& disc, SampleBand& band) const {
  constexpr int n = SampleBand::per_pixel;
  const auto [first_x, last_x] =
      sample_range(disc.pixel.x() - disc.radius, disc.pixel.x() + disc.radius, 0, band.sample_width());
  const auto [first_y, last_y] = sample_range(disc.pixel.y() - disc.radius, disc.pixel.y() + disc.radius,
                                              band.first_row * n, band.last_row * n);
  const PictureSurface& surface = surfaces_[static_cast<std::size_t>(disc.surface)];
  for (int y = first_y; y < last_y; ++y) {
    for (int x = first_x; x < last_x; ++x) {
      const double r = (Pixel(middle_of(x), middle_of(y)) - disc.pixel).norm() / disc.radius;
      const std::size_t at = band.index(x, y);
      if (r > 1 || static_cast<float>(disc.nearness) < band.nearness[at]) continue;
      band.colour[at] = r < 0.66 ? surface.front : surface.back;  // a rim in the second colour
      band.nearness[at] = static_cast<float>(disc.nearness);
    }
  }
}

Image Rasteriser::draw(const Backdrop& backdrop, const Veil& veil) const {
  constexpr int n = SampleBand::per_pixel;
  Image image{width_, height_, {}};
  image.pixels.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int first = 0; first < height_; first += band_rows) {
    SampleBand band;
    band.width = width_;
    band.first_row = first;
    band.last_row = std::min(first + band_rows, height_);
    for (int row = first; row < band.last_row; ++row)
      band.colour.insert(band.colour.end(), static_cast<std::size_t>(n * n * width_), backdrop(row));
    band.nearness.assign(band.colour.size(), 0.0F);
    for (const Triangle& triangle : triangles_)
      if (triangle.bottom >= first && triangle.top <= band.last_row) draw_triangle(triangle, band);
    veil(band);
    for (const Disc& disc : discs_) draw_disc(disc, band);
    for (int y = first; y < band.last_row; ++y) {
      for (int x = 0; x < width_; ++x) {
        Colour sum = Colour::Zero();
        for (int sy = 0; sy < n; ++sy)
          for (int sx = 0; sx < n; ++sx) sum += band.colour[band.index(n * x + sx, n * y + sy)];
        image.pixels.push_back(encoded(sum / (n * n)));
      }
    }
  }
  return image;
}

}  // namespace cloth
