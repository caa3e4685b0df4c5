// Triangles, lines and discs with a depth buffer, three by three samples to a pixel. First everything is put
// on a list, then the picture is drawn in bands of rows, so that the samples of a band stay in the cache.
#pragma once

#include <functional>
#include <span>

#include "picture/light.h"

namespace cloth {

struct PictureVertex {
  Vec3 position;           ///< m
  Eigen::Vector3f normal;  ///< unit vector; zero: each triangle's own
  float u = 0, v = 0, strain = 0;
};

/// The samples of some rows of the picture; nearness is 1/depth, 0 where nothing is.
struct SampleBand {
  static constexpr int per_pixel = 3;          ///< either way
  int width = 0, first_row = 0, last_row = 0;  ///< px
  std::vector<Colour> colour;
  std::vector<float> nearness;

  int sample_width() const { return width * per_pixel; }
  std::size_t index(int sample_x, int sample_y) const {
    return static_cast<std::size_t>(sample_y - first_row * per_pixel) *
               static_cast<std::size_t>(sample_width()) +
           static_cast<std::size_t>(sample_x);
  }
};

class Rasteriser {
 public:
  /// `light` must outlive it.
  Rasteriser(const EyeFrame& frame, const Light& light, int width, int height)
      : frame_(frame), light_(light), width_(width), height_(height) {}

  int add_surface(const PictureSurface& surface);
  /// Triples of indices into `vertices`; counter-clockwise seen from the front. What is not finite is left
  /// out.
  void add_mesh(std::span<const PictureVertex> vertices, std::span<const int> triangles, int surface);
  /// A straight line of even width (px).
  void add_line(const Vec3& from, const Vec3& to, double width, int surface);
  /// An arrow whose head is `head` px long.
  void add_arrow(const Vec3& from, const Vec3& to, double width, double head, int surface);
  void add_disc(const Vec3& middle, double diameter, int surface);

  using Backdrop = std::function<Colour(int row)>;
  using Veil = std::function<void(SampleBand&)>;
  /// The picture; `veil` is laid over every band before the discs.
  Image draw(const Backdrop& backdrop, const Veil& veil) const;

 private:
  struct Corner {
    Eigen::Vector2d pixel;
    double nearness;
    SeenPoint seen;
  };
  struct Triangle {
    std::array<Corner, 3> corner;
    int surface;
    double top, bottom;  ///< px
  };
  struct Disc {
    Eigen::Vector2d pixel;
    double nearness, radius;
    int surface;
  };

  double nearness_of(double depth, int surface) const;  ///< 1/m
  void add_triangle(const std::array<PictureVertex, 3>& vertices, int surface);
  void add_flat(const std::array<Eigen::Vector2d, 3>& pixels, const std::array<double, 3>& nearness,
                int surface);
  void draw_triangle(const Triangle& triangle, SampleBand& band) const;
  void draw_disc(const Disc& disc, SampleBand& band) const;

  EyeFrame frame_;
  const Light& light_;
  int width_, height_;
  std::vector<PictureSurface> surfaces_;
  std::vector<Triangle> triangles_;
  std::vector<Disc> discs_;
};

}  // namespace cloth
