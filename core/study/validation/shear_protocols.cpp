// The picture frame: what pulls at the corners of a sheared sheet says its shear stiffness.
#include <cmath>
#include <numbers>

#include "exact/shear_frame.h"
#include "scene/scene_cloth.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

constexpr double side = 0.1, shear = 35;         // m, N/m
constexpr double stretch = 100 * shear;          // N/m
constexpr double bending = shear * side * side;  // N m: enough to keep the sheet flat
constexpr double bulge = 0.03;                   // of the start, over the side
constexpr exact::ShearLaw law = exact::ShearLaw::diagonals;

/// A square between four hinged bars, weft and warp along them.
Scene framed_scene(int cells) {
  Scene scene;
  scene.cloth.columns = scene.cloth.rows = cells + 1;
  scene.cloth.width = scene.cloth.height = side;
  scene.cloth.origin = Vec3::Zero(), scene.cloth.across = {1, 0, 0}, scene.cloth.down = {0, 1, 0};
  scene.cloth.pins = {NamedPin::top_edge, NamedPin::bottom_edge, NamedPin::left_edge, NamedPin::right_edge};
  scene.gravity = Vec3(1e-6, -1e-6, 0);  // across the pull, to which it adds nothing
  scene.material = Material{.areal_density = 0.2,
                            .stretch_warp = stretch,
                            .stretch_weft = stretch,
                            .shear = shear,
                            .bending_warp = bending,
                            .bending_weft = bending,
                            .twist = bending};
  return scene;
}

/// Where the frame takes a point of the flat square, and how fast it goes there with gamma (m, m/rad). The
/// pulled diagonal stays where it is.
struct FramedPoint {
  Vec3 place, rate;
};
FramedPoint framed(const Vec3& flat, double gamma) {
  const double c = std::cos(gamma / 2), s = std::sin(gamma / 2);
  return {{flat.x() * c + flat.y() * s, flat.x() * s + flat.y() * c, 0},
          Vec3(flat.y() * c - flat.x() * s, flat.x() * c - flat.y() * s, 0) / 2};
}

/// Pull at the corners of the resting sheet, N: the power of what holds its border over the corners' speed.
ValidationReading pull_of_frame(double gamma, int cells) {
  const Scene scene = framed_scene(cells);
  const ClothSystem system = make_cloth(scene);
  Vec3Field start(system.start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3 flat = system.start[i];
    const double hill = std::sin(std::numbers::pi * flat.x() / side) *
                        std::sin(std::numbers::pi * flat.y() / side) * bulge * side;
    start.set(i, framed(flat, gamma).place + (system.pinned[i] ? 0 : hill) * Vec3(1, -0.5, 0.5));
  }
  const RestShape rest = find_rest(scene, system, start);
  const Vec3Field force = conservative_forces(scene, system, rest.position);
  double power = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (system.pinned[i]) power -= force[i].dot(framed(system.start[i], gamma).rate);
  const double speed = side * std::sin(std::numbers::pi / 4 - gamma / 2);  // d(extension)/d(gamma)
  return {.value = power / speed, .failure = rest.failure};
}

ValidationProtocol picture_frame() {
  ValidationProtocol protocol{"picture-frame", "gamma", {0.05, 0.1, 0.2, 0.4, 0.8}, {}, {}};
  protocol.expect = [](double) {
    return ValidationRow{
        .quantity =
            "C66 in N/m from the pull at two opposite corners of a square frame of hinged bars, "
            "sheared by gamma in rad; linear springs along the diagonals of square cells",
        .source = "Cao et al. 2008",
        .method =
            "at rest from a bulged start, by Newton's method; cells of any size shear alike, so that "
            "rounding alone is left",
        .exact = shear,
        .promise = Promise::exact};
  };
  protocol.measure = [](const ValidationRow& row, int cells) {
    ValidationReading reading = pull_of_frame(row.parameter, cells);
    reading.value = exact::shear_stiffness_of_frame(law, reading.value, side, row.parameter);
    return reading;
  };
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> shear_protocols() {
  return {picture_frame()};
}

}  // namespace cloth
