#include "picture/light.h"

#include <algorithm>
#include <cmath>

#include "picture/strain_colours.h"

namespace cloth {
namespace {

const Colour key_colour(1.00F, 0.97F, 0.92F), fill_colour(0.88F, 0.94F, 1.00F);
constexpr float hidden_darkness = 0.75F;  // of the key light, lost in a shadow

float decoded(std::uint8_t channel) {
  const double c = channel / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::uint8_t encoded_channel(float linear) {
  const double x = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  const double c = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * c));
}

/// Rolls highlights off instead of clipping them; the identity for dark and middle tones.
float soft_clip(float c) {
  const float over = std::max(c - 0.7F, 0.0F);
  return std::min(c, 0.7F) + over / (1 + over / 0.3F);
}

bool on_band(float at, float bands) {
  const float place = at * bands;
  return place - std::floor(place) < 0.5F;
}

Colour woven_colour(const PictureSurface& surface, const SeenPoint& point) {
  const Colour& ground = point.front ? surface.front : surface.back;
  if (surface.weave == Weave::plain) return ground;
  float share = on_band(point.u, surface.bands.x()) ? 0.5F : 0.0F;
  if (surface.weave == Weave::stripes) share *= 2;
  if (surface.weave == Weave::checks && on_band(point.v, surface.bands.y())) share += 0.5F;
  return (1 - share) * ground + share * (point.front ? surface.front_thread : surface.back_thread);
}

const std::array<Colour, strain_colour_count>& linear_strain_colours() {
  static const auto colours = [] {
    std::array<Colour, strain_colour_count> made;
    for (std::size_t i = 0; i < made.size(); ++i) made[i] = linear_light(strain_colours()[i]);
    return made;
  }();
  return colours;
}

}  // namespace

Colour linear_light(Rgb colour) {
  return {decoded(colour.red), decoded(colour.green), decoded(colour.blue)};
}

Rgb encoded(const Colour& linear) {
  return {encoded_channel(linear.x()), encoded_channel(linear.y()), encoded_channel(linear.z())};
}

Light::Light(const EyeFrame& frame, float exposure) : eye_(frame.eye.cast<float>()), exposure_(exposure) {
  const Vec3 key = Vec3(-0.20, 0.70, 0.20) - 0.35 * frame.forward - 0.65 * frame.right;
  const Vec3 fill = 0.9 * frame.right - 0.45 * frame.forward - 0.1 * frame.up;
  key_ = key.normalized().cast<float>();
  fill_ = fill.normalized().cast<float>();
  shadow_ = Vec3(0.35 * key.x(), 0.9, 0.35 * key.z()).normalized();
}

// wrap softens the terminator as cloth does; through: share of the key light that a thin sheet lets shine
// through from behind; gloss: Blinn-Phong's specular strength, at an exponent of 16.
Colour Light::lit(const Colour& albedo, const SeenPoint& point, float wrap, float through,
                  float gloss) const {
  const Eigen::Vector3f& n = point.normal;
  const Eigen::Vector3f to_eye = (eye_ - point.position).normalized();
  const float facing = n.dot(key_);
  // Nothing is told of shadows in light that grazes the surface: there each point would lie in its
  // neighbour's.
  const float told = hidden_darkness * std::min(4 * std::abs(facing), 1.0F);
  const float reached = hidden_ == nullptr ? 1 : 1 - told * hidden_->at(point.position);
  const float key =
      reached * (std::max((facing + wrap) / (1 + wrap), 0.0F) + through * std::max(-facing, 0.0F));
  const float fill = std::max(n.dot(fill_), 0.0F);
  const float sky = 0.5F + 0.5F * n.y();
  const Colour ambient = (1 - sky) * Colour(0.34F, 0.335F, 0.33F) + sky * Colour(0.27F, 0.28F, 0.30F);
  const Colour light = ambient + 0.78F * key * key_colour + 0.24F * fill * fill_colour;
  const float half_way = std::max(n.dot((to_eye + key_).normalized()), 0.0F);
  const float squared = half_way * half_way, fourth = squared * squared, eighth = fourth * fourth;
  const float highlight = reached * gloss * eighth * eighth * std::clamp(5 * facing, 0.0F, 1.0F);
  return (exposure_ * (albedo.cwiseProduct(light) + highlight * key_colour)).unaryExpr(&soft_clip);
}

Colour Light::shade(const PictureSurface& surface, const SeenPoint& point) const {
  switch (surface.look) {
    case Look::flat:
      break;
    case Look::matte:
      return lit(surface.front, point, 0.3F, 0, 0.06F);
    case Look::woven:
      return lit(woven_colour(surface, point), point, 0.15F, 0.42F, 0.05F);
    case Look::strain: {
      // Form is told by a little shading only: colours must stay readable against the legend.
      const float fraction = std::clamp(point.strain, 0.0F, 1.0F);
      const auto i = static_cast<std::size_t>(std::lround(fraction * (strain_colour_count - 1)));
      return (0.78F + 0.22F * std::clamp(0.55F + 0.6F * point.normal.dot(key_), 0.0F, 1.0F)) *
             linear_strain_colours()[i];
    }
  }
  return surface.front;
}

}  // namespace cloth
