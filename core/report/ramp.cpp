#include "report/ramp.h"

#include <algorithm>

namespace cloth {

const std::vector<PageColour>& ramp_colours() {
  static const std::vector<PageColour> colours = {
      {"ramp0", "#1c3f95", "#6d8df0"}, {"ramp1", "#5b2a9d", "#9b7df2"}, {"ramp2", "#8d2396", "#c877e6"},
      {"ramp3", "#b52f83", "#e87cc4"}, {"ramp4", "#cf4a66", "#f88f9c"}, {"ramp5", "#d95f45", "#fcab78"},
      {"ramp6", "#c9710f", "#f7cd5e"}};
  return colours;
}

std::size_t ramp_class(double value, double low, double high) {
  const auto classes = static_cast<double>(ramp_colours().size());
  const double place = high > low ? (value - low) / (high - low) : 0.5;
  return static_cast<std::size_t>(std::clamp(place * classes, 0.0, classes - 1));
}

}  // namespace cloth
