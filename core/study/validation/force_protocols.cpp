// What strips push with, and how they swing.
#include <cmath>

#include "cloth/grid.h"
#include "exact/bessel_zero.h"
#include "exact/strip_tests.h"
#include "exact/swing.h"
#include "scene/scene_cloth.h"
#include "simulation/simulation.h"
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
  protocol.measure = [strip = protocol.strip](const ValidationRow& row, int cells, const StopTest& stop) {
    const StripCase of = strip(row.parameter, cells);
    const StripRest found = rest_of_strip(of, row.curve, stop);
    const Vec3 push = force_of_end(strip_scene(of, row.curve), found.rest.position);
    return ValidationReading{
        .value = std::abs(push.x() / push.y()), .failure = found.rest.failure, .points = found.points};
  };
  return protocol;
}

constexpr double swing_amplitude = 1e-3;  // over the length

/// A strip that hangs from its first end along x.
Scene hanging_strip(double mass_damping, int cells) {
  Scene scene = strip_scene({.load = 1, .bends = false, .stretch = 2e5, .cells = cells},
                            {{}, StripEnd::pinned, StripEnd::free});
  scene.gravity = gravity_of(scene).norm() * scene.cloth.across;
  scene.material->mass_damping = mass_damping;
  scene.integrator.method = "verlet";
  return scene;
}

/// First mode of a hanging chain (Bernoulli 1738), at an arc from its upper end.
double chain_mode(double arc) {
  return std::cyl_bessel_j(0.0, exact::first_bessel_zero(0) * std::sqrt(std::max(0.0, 1 - arc)));
}

/// The logarithm of the speed at one passage through the middle over that at the next but one, one swing
/// later; of the part of the motion in the first mode.
ValidationReading decrement_of_swing(double mass_damping, int cells, const StopTest& stop) {
  const Scene scene = hanging_strip(mass_damping, cells);
  const ClothSystem resting = make_cloth(scene);
  const RestShape rest = find_rest(scene, resting, resting.start, {.stop = stop});
  if (!rest.found) return {.failure = rest.failure};
  std::vector<double> mode(rest.position.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = chain_mode(resting.start[i].x() / strip_length);
  Simulation simulation(scene, [&](ClothSystem&, ClothState& state) {
    state.position = rest.position;
    for (std::size_t i = 0; i < mode.size(); ++i)
      state.position.y()[i] += swing_amplitude * strip_length * mode[i];
  });
  const auto part = [&](const double* of) {
    double sum = 0;
    for (std::size_t i = 0; i < mode.size(); ++i) sum += resting.mass[i] * mode[i] * of[i];
    return sum;
  };
  std::vector<double> passages;
  double place = part(simulation.state().position.y()), speed = 0;
  while (passages.size() < 3) {
    if (is_to_stop(stop)) return {.failure = "stopped"};
    if (const auto divergence = simulation.step()) return {.failure = describe(*divergence)};
    const double next = part(simulation.state().position.y()),
                 next_speed = part(simulation.state().velocity.y());
    if (place * next < 0) {
      const double share = place / (place - next);
      passages.push_back(std::abs(speed + share * (next_speed - speed)));
    }
    place = next, speed = next_speed;
  }
  return {.value = std::log(passages[0] / passages[2])};
}

ValidationProtocol swing() {
  ValidationProtocol protocol{"swing", "damping", {0.5, 4}, {}, {}};
  protocol.expect = [](double mass_damping) {
    const double frequency = exact::hanging_chain_frequency(strip_length, standard_gravity);
    return ValidationRow{
        .quantity = "logarithmic decrement of a hanging strip without bending; damping in 1/s",
        .source = "Bernoulli 1738; Meirovitch 1986",
        .method = "one swing, from the first mode on, by Verlet at its automatic step",
        .exact = exact::damped_swing(frequency, mass_damping).decrement};
  };
  protocol.measure = [](const ValidationRow& row, int cells, const StopTest& stop) {
    return decrement_of_swing(row.parameter, cells, stop);
  };
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> force_protocols() {
  return {stick_slip(), swing()};
}

const std::vector<ValidationProtocol>& protocols() {
  static const std::vector<ValidationProtocol> all = [] {
    std::vector<ValidationProtocol> sum = shape_protocols();
    for (auto more : {buckling_protocols, force_protocols, shear_protocols, drape_protocols})
      for (ValidationProtocol& one : more()) sum.push_back(std::move(one));
    return sum;
  }();
  return all;
}

}  // namespace cloth
