// What strips push with, and how they swing.
#include <cmath>

#include "cloth/grid.h"
#include "exact/strip_tests.h"
#include "exact/swing.h"
#include "scene/scene_cloth.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

constexpr double weightless = 1e-6;  // Gamma beside a force of 20 on the tip

/// What the last column of a strip at rest exerts on what holds it, N.
Vec3 force_of_end(const Scene& scene, const Vec3Field& position) {
  const ClothSystem system = make_cloth(scene);
  const Vec3Field force = conservative_forces(scene, system, position);
  Vec3 sum = Vec3::Zero();
  for (int row = 0; row < system.rows; ++row)
    sum += force[static_cast<std::size_t>(system.index(row, system.columns - 1))];
  return sum;
}

ValidationProtocol stick_slip() {
  ValidationProtocol protocol{"stick-slip", "eps", {0.01, 0.05, 0.1, 0.2, 0.3}, {}, {}};
  protocol.expect = [](double eps) {
    ValidationRow row{.quantity = "friction |T/N| below which the tip of a pressed strip slips",
                      .source = "Sano et al. 2017; Romero et al. 2021",
                      .method = "at rest, by Newton's method, the tip held where it touches"};
    if (const auto exact = exact::pressed_strip(eps))
      row.exact = exact->friction, row.curve = {exact->points, StripEnd::clamped, StripEnd::pinned};
    else
      row.failure = "there is no exact curve for this depth";
    return row;
  };
  protocol.strip = [](double, int cells) { return StripCase{.load = weightless, .cells = cells}; };
  protocol.measure = [strip = protocol.strip](const ValidationRow& row, int cells) {
    const StripCase of = strip(row.parameter, cells);
    const StripRest found = rest_of_strip(of, row.curve);
    const Vec3 push = force_of_end(strip_scene(of, row.curve), found.rest.position);
    return ValidationReading{
        .value = std::abs(push.x() / push.y()), .distance = 0, .failure = found.rest.failure};
  };
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> force_protocols() {
  return {stick_slip()};
}

const std::vector<ValidationProtocol>& protocols() {
  static const std::vector<ValidationProtocol> all = [] {
    std::vector<ValidationProtocol> sum = shape_protocols();
    for (auto more : {buckling_protocols, force_protocols})
      for (ValidationProtocol& one : more()) sum.push_back(std::move(one));
    return sum;
  }();
  return all;
}

}  // namespace cloth
