// What pulls at a sheared sheet says its shear stiffness: the picture frame, on grids, and bias extension, on
// meshes of triangles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "exact/shear_frame.h"
#include "geometry/triangle_mesh.h"
#include "scene/scene_cloth.h"
#include "scene/scene_mesh.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

constexpr double side = 0.1, shear = 35;         // m, N/m
constexpr double stretch = 100 * shear;          // N/m
constexpr double bending = shear * side * side;  // N m: enough to keep the sheet flat
constexpr double bulge = 0.03;                   // of the start, over the side
constexpr exact::ShearLaw law = exact::ShearLaw::diagonals;

/// Where a point of the flat sheet is held, and how fast it goes there with gamma (m, m/rad).
struct FramedPoint {
  Vec3 place, rate;
};
using Framing = FramedPoint (*)(const Vec3& flat, double gamma);

/// The power of what holds the pinned particles of the resting sheet over `speed`, at which what is pulled
/// moves apart with gamma (m/rad): N. `disturbance` in m moves the free ones at the start.
ValidationReading pull_at_rest(const Scene& scene, double gamma, Framing framing,
                               Vec3 (*disturbance)(const Vec3& flat), double speed, const StopTest& stop) {
  const ClothSystem system = make_cloth(scene);
  Vec3Field start(system.start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    start.set(i, framing(system.start[i], gamma).place);
    if (!system.pinned[i]) start.add(i, disturbance(system.start[i]));
  }
  const RestShape rest = find_rest(scene, system, start, {.stop = stop});
  const Vec3Field force = conservative_forces(scene, system, rest.position);
  double power = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (system.pinned[i]) power -= force[i].dot(framing(system.start[i], gamma).rate);
  return {.value = power / speed, .failure = rest.failure};
}

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

/// Where the frame takes a point of the flat square. The pulled diagonal stays where it is.
FramedPoint framed(const Vec3& flat, double gamma) {
  const double c = std::cos(gamma / 2), s = std::sin(gamma / 2);
  return {{flat.x() * c + flat.y() * s, flat.x() * s + flat.y() * c, 0},
          Vec3(flat.y() * c - flat.x() * s, flat.x() * c - flat.y() * s, 0) / 2};
}

/// Pull at the corners of the resting sheet, N.
ValidationReading pull_of_frame(double gamma, int cells, const StopTest& stop) {
  const auto bulged = [](const Vec3& flat) -> Vec3 {
    return std::sin(std::numbers::pi * flat.x() / side) * std::sin(std::numbers::pi * flat.y() / side) *
           bulge * side * Vec3(1, -0.5, 0.5);
  };
  const double speed = side * std::sin(std::numbers::pi / 4 - gamma / 2);
  return pull_at_rest(framed_scene(cells), gamma, framed, bulged, speed, stop);
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
  protocol.measure = [](const ValidationRow& row, int cells, const StopTest& stop) {
    ValidationReading reading = pull_of_frame(row.parameter, cells, stop);
    reading.value = exact::shear_stiffness_of_frame(law, reading.value, side, row.parameter);
    return reading;
  };
  return protocol;
}

// ---- bias extension ----

constexpr double strip_width = 0.04, bias_length = 2.5 * strip_width;  // m
constexpr double inextensible = 1e8 * shear;                           // N/m

/// Where inextensible threads take a point of the strip that is pulled along x, its middle sheared by gamma,
/// and how fast it goes there with gamma. A point is a place on a warp thread and one on a weft thread, 45
/// degrees to either side of the pull; beside the ends both keep their directions, in the middle both turn by
/// gamma/2.
FramedPoint bias_extended(const Vec3& flat, double gamma) {
  constexpr double end = strip_width / 2;
  const auto along_thread = [&](double place, double side_of_pull) {
    const double turned = std::clamp(place, end, bias_length - end) - end, straight = place - turned;
    const double angle = std::numbers::pi / 4, now = angle - gamma / 2;
    const Vec3 kept(std::cos(angle), side_of_pull * std::sin(angle), 0);
    const Vec3 turn(std::cos(now), side_of_pull * std::sin(now), 0);
    const Vec3 rate(std::sin(now) / 2, -side_of_pull * std::cos(now) / 2, 0);
    return FramedPoint{(straight * kept + turned * turn) * std::numbers::sqrt2 / 2,
                       turned * std::numbers::sqrt2 / 2 * rate};
  };
  const FramedPoint warp = along_thread(flat.x() + flat.y(), 1), weft = along_thread(flat.x() - flat.y(), -1);
  return {warp.place + weft.place, warp.rate + weft.rate};
}

/// A strip of squares, each cut along both diagonals, which its threads follow; the ends are held.
Scene bias_scene(int cells) {
  const int across = cells * 2 / 5, columns = cells + 1;
  const double cell = bias_length / cells;
  TriangleMesh mesh;
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i <= cells; ++i) mesh.vertices.emplace_back(cell * i, cell * j - strip_width / 2, 0);
  Scene scene;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
      const int middle = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back((mesh.vertices[at(a)] + mesh.vertices[at(c)]) / 2);
      for (const auto& [from, to] : {std::pair(a, b), {b, c}, {c, d}, {d, a}})
        mesh.triangles.push_back({from, to, middle});
    }
  for (int j = 0; j <= across; ++j)
    for (const int i : {0, cells}) scene.cloth.pins.emplace_back(PinnedParticle{0, j * columns + i});
  scene.cloth.rows = 1, scene.cloth.columns = static_cast<int>(mesh.vertices.size());
  scene.cloth.mesh = made_mesh("bias-extension.obj", mesh);
  scene.cloth.origin = Vec3::Zero(), scene.cloth.down = {1, 1, 0}, scene.cloth.across = {1, -1, 0};
  scene.gravity = Vec3(0, 1e-6, 0);
  scene.material = Material{
      .areal_density = 0.2, .stretch_warp = inextensible, .stretch_weft = inextensible, .shear = shear};
  return scene;
}

/// Pull at the end of the resting strip, N.
ValidationReading pull_of_strip(double gamma, int cells, const StopTest& stop) {
  const auto bulged = [](const Vec3& flat) -> Vec3 {
    return std::sin(std::numbers::pi * flat.x() / bias_length) * bulge * strip_width * Vec3(1, -0.5, 0);
  };
  const double speed =
      (bias_length - strip_width) / std::numbers::sqrt2 * std::sin(std::numbers::pi / 4 - gamma / 2);
  return pull_at_rest(bias_scene(cells), gamma, bias_extended, bulged, speed, stop);
}

ValidationProtocol bias_extension() {
  ValidationProtocol protocol{"bias-extension", "gamma", {0.1, 0.4, 0.8}, {}, {}};
  protocol.expect = [](double) {
    return ValidationRow{
        .quantity =
            "C66 in N/m from the pull at a strip cut at 45 degrees, 2.5 times as long as it is wide, its "
            "middle sheared by gamma in rad; triangles of constant strain, stretch 1e8 times C66",
        .source = "Cao et al. 2008",
        .method =
            "at rest from a disturbed start, by Newton's method, threads along the edges of triangles; the "
            "closed "
            "form takes every zone to shear evenly, and the least energy lies up to 0.4 % below",
        .exact = shear,
        .promise = Promise::error};
  };
  protocol.measure = [](const ValidationRow& row, int cells, const StopTest& stop) {
    ValidationReading reading = pull_of_strip(row.parameter, cells, stop);
    reading.value /=
        exact::bias_extension_force(exact::ShearLaw::green, 1, bias_length, strip_width, row.parameter);
    return reading;
  };
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> shear_protocols() {
  return {picture_frame(), bias_extension()};
}

}  // namespace cloth
