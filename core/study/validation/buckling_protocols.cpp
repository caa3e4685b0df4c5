// Loads at which heavy strips buckle, and the overhang at which a chord has the angle of ASTM D1388.
#include <cmath>

#include "exact/heavy_strip.h"
#include "scene/scene_cloth.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

/// Where `is_beyond` becomes true between two loads.
double threshold(double low, double high, const StopTest& stop,
                 const std::function<bool(double)>& is_beyond) {
  while (high / low - 1 > 1e-7 && !is_to_stop(stop)) {
    const double middle = std::sqrt(low * high);
    (is_beyond(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

const char* const buckling_method =
    "the load at which the rest of the straight strip, by Newton's method, is no minimum of the energy";

ValidationProtocol astm() {
  ValidationProtocol protocol{"astm-d1388", "", {0}, {}, {}};
  protocol.expect = [](double) {
    return ValidationRow{.quantity = "overhang at 41.5 degrees over the bending length",
                         .source = "ASTM D1388; Peirce 1930",
                         .method = "rests by Newton's method, until the chord has the angle",
                         .exact = std::cbrt(exact::gamma_of_chord(exact::astm_chord))};
  };
  protocol.measure = [](const ValidationRow&, int cells, const StopTest& stop) {
    ValidationReading reading;
    const double gamma = threshold(4, 16, stop, [&](double load) {
      const StripRest found =
          rest_of_strip({.load = load, .cells = cells},
                        {exact::heavy_cantilever(load).points, StripEnd::clamped, StripEnd::free}, stop);
      if (!found.rest.found) reading.failure = found.rest.failure;
      const Eigen::Vector2d chord = found.points.back() - found.points.front();
      return std::atan2(-chord.y(), chord.x()) > exact::astm_chord;
    });
    reading.value = std::cbrt(gamma);
    return reading;
  };
  return protocol;
}

/// Whether a strip that is straight at rest gives way sideways under this load.
bool gives_way(const Scene& scene, const StopTest& stop, std::string& failure) {
  const ClothSystem system = make_cloth(scene);
  const RestShape rest = find_rest(scene, system, system.start, {.stop = stop});
  if (!rest.found) failure = rest.failure;
  return !is_minimum(scene, system, rest.position);
}

ValidationProtocol self_buckling() {
  ValidationProtocol protocol{"self-buckling", "", {0}, {}, {}};
  protocol.expect = [](double) {
    return ValidationRow{.quantity = "Gamma at which a standing strip buckles",
                         .source = "Greenhill 1881",
                         .method = buckling_method,
                         .exact = exact::self_buckling_gamma()};
  };
  protocol.measure = [](const ValidationRow&, int cells, const StopTest& stop) {
    ValidationReading reading;
    reading.value = threshold(6, 10, stop, [&](double load) {
      Scene scene = strip_scene({.load = load, .cells = cells}, {{}, StripEnd::clamped, StripEnd::free});
      scene.gravity = -gravity_of(scene).norm() * scene.cloth.across;
      return gives_way(scene, stop, reading.failure);
    });
    return reading;
  };
  return protocol;
}

/// On edge, clamped at one end, so many times as long as it is wide; square cells.
double lateral_load(int slenderness, int across, const StopTest& stop, std::string& failure) {
  return threshold(12, 30, stop, [&](double load) {
    Scene scene = strip_scene({.load = load, .cells = slenderness * across, .across = across},
                              {{}, StripEnd::clamped, StripEnd::free});
    scene.gravity = gravity_of(scene).norm() * scene.cloth.down;
    return gives_way(scene, stop, failure);
  });
}

ValidationProtocol lateral_buckling() {
  ValidationProtocol protocol{"lateral-buckling", "", {0}, {}, {}};
  protocol.expect = [](double) {
    return ValidationRow{
        .quantity =
            "Gamma at which a strip on edge tilts, extrapolated to no width from 5, 10 and 20 times "
            "as long as wide; cells of the second",
        .source = "Timoshenko and Gere 1961",
        .method = buckling_method,
        .exact = exact::lateral_buckling_gamma(1),
        .promise = Promise::error};  // the corners of the clamp leave no order
  };
  protocol.measure = [](const ValidationRow&, int cells, const StopTest& stop) {
    ValidationReading reading;
    const auto load = [&](int slenderness) {
      return lateral_load(slenderness, cells / 10, stop, reading.failure);
    };
    reading.value = (load(5) - 6 * load(10) + 8 * load(20)) / 3;  // a parabola in the width, at none
    return reading;
  };
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> buckling_protocols() {
  return {astm(), self_buckling(), lateral_buckling()};
}

}  // namespace cloth
