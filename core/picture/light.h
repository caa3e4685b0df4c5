// Light and surfaces of a picture: Blinn-Phong in linear light, as the window's shaders have it, with more
// light thrown back by the floor: a picture cannot be turned to see a dark side.
#pragma once

#include <Eigen/Core>

#include "picture/image.h"
#include "picture/key_shadow.h"
#include "picture/picture_camera.h"

namespace cloth {

using Colour = Eigen::Vector3f;  ///< linear light, 0 to 1

Colour linear_light(Rgb colour);
Rgb encoded(const Colour& linear);

enum class Look {
  flat,    ///< the front colour, unlit: lines and markers
  matte,   ///< obstacles
  woven,   ///< the cloth, its pattern from u and v
  strain,  ///< the cloth, coloured by strain
};

enum class Weave { plain, checks, stripes };

struct PictureSurface {
  Look look = Look::matte;
  Colour front = Colour::Constant(0.5F), back = Colour::Constant(0.5F);
  Colour front_thread = front, back_thread = back;  ///< of the pattern's bands
  Weave weave = Weave::plain;
  Eigen::Vector2f bands{9, 9};  ///< of the pattern, across and down
  float nearer = 0;             ///< share of its distance by which it is drawn nearer (negative: farther)
};

/// What is known of a surface where it is seen.
struct SeenPoint {
  Eigen::Vector3f position;  ///< m
  Eigen::Vector3f normal;    ///< unit vector on the viewer's side
  float u = 0, v = 0;        ///< 0 to 1 over the cloth
  float strain = 0;          ///< 0 to 1 of the scale
  bool front = true;
};

class Light {
 public:
  /// The key light goes half way with the eye, so that folds read alike from every side.
  Light(const EyeFrame& frame, float exposure);

  /// Nothing is hidden from the key light until then. `shadow` must outlive the light.
  void set_key_shadow(const KeyShadow* shadow) { hidden_ = shadow; }
  Vec3 key_direction() const { return key_.cast<double>(); }  ///< unit vector, towards the light

  Colour shade(const PictureSurface& surface, const SeenPoint& point) const;
  /// Towards the light that casts shadows on the floor: the key light, raised.
  Vec3 shadow_direction() const { return shadow_; }

 private:
  Colour lit(const Colour& albedo, const SeenPoint& point, float wrap, float through, float gloss) const;

  Eigen::Vector3f eye_, key_, fill_;
  Vec3 shadow_;
  const KeyShadow* hidden_ = nullptr;
  float exposure_;
};

}  // namespace cloth
