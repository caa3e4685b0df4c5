#include "params/doubt.h"

#include <cmath>

namespace cloth {
namespace {

/// Largest magnitude that makes sense for one parameter, or for all of a unit where there is no key.
struct Sense {
  const char* key;
  const char* unit;
  double largest;
  const char* reason;
};

constexpr Sense senses[] = {
    {"time_step", "s", 0.2, "Longer than a cloth takes for a swing: no method follows its motion"},
    {"duration", "s", 1e5, "More than a day of simulated time"},
    {"gravity", "m/s^2", 1000, "A hundred times what the Earth has: any cloth is torn"},
    {"", "N/m", 1e7,
     "Far stiffer than any cloth: the stable step of explicit methods falls with the root of the stiffness, "
     "and equations of "
     "implicit ones lose their digits"},
    {"", "N s/m", 1e4,
     "Far more damping than any cloth has: the stable step of explicit methods falls with it, and nothing "
     "moves"},
    {"", "kg", 1000, "Heavier than any cloth"},
    {"width", "m", 100, "Larger than any cloth: gaps between its particles become longer than its folds"},
    {"height", "m", 100, "Larger than any cloth: gaps between its particles become longer than its folds"},
    {"", "m/s", 340,
     "Faster than sound: the law of the air's force does not hold, and obstacles leap past the cloth"},
    {"", "m", 1e5, "So far away that positions lose the digits that a cloth needs"},
};

}  // namespace

std::optional<std::string> doubt_about(const ParameterInfo& info, const ParameterValue& value) {
  double size = 0;
  if (const auto* number = std::get_if<double>(&value)) size = std::abs(*number);
  if (const auto* vector = std::get_if<Vec3>(&value)) size = vector->lpNorm<Eigen::Infinity>();
  for (const Sense& sense : senses) {
    const bool is_meant = sense.unit == info.unit && (*sense.key == 0 || sense.key == info.key);
    if (is_meant && size > sense.largest) return sense.reason;
  }
  return std::nullopt;
}

}  // namespace cloth
