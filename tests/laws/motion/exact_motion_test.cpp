// Motions of whole cloths, rings and chains that are known in closed form: every method tends to them at its
// order; a flat sheet in gusts, which tells a wrong stage time; and a
// motion chosen freely and made exact by the load that it needs.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <numbers>

#include "cloth/grid.h"
#include "geometry/dense_decompositions.h"
#include "integrators/registry.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"
#include "support/test_names.h"

namespace cloth::test::exact_motion_test {
namespace {

using std::numbers::pi;

constexpr double stiffness = 40, mass = 0.01, length = 0.1;  // N/m, kg, m

class ExactMotion : public ::testing::TestWithParam<std::string> {};

/// A motion to follow: what moves, from where, and how far a state is from the exact one at its time.
struct Motion {
  ClothSystem system;
  Scene scene;  ///< its forces beside the springs
  ClothState start = {};
  std::function<double(const ClothState&)> distance = {};  ///< m
  double time = 1;                                         ///< s
  double frequency = 1;                                    ///< 1/s, of the fastest part that is excited
  std::function<std::unique_ptr<Force>()> load = {};       ///< one more force, made anew for every run
};

/// omega h at which a method of this order is asymptotic and far above rounding.
double resolution(int order) {
  return std::map<int, double>{{1, 0.02}, {2, 0.08}, {4, 0.2}, {5, 0.12}}.at(order);
}

/// `fastest`: the largest frequency in rad/s.
double error_after(const Motion& motion, const std::string& method, int steps, double fastest) {
  DirectRun run(motion.system, motion.scene, exactly(method, {}, 1.5 * fastest * motion.time / steps));
  run.state = motion.start;
  if (motion.load) run.forces.add(motion.load());
  run.advance(steps, motion.time / steps);
  return motion.distance(run.state);
}

/// The error vanishes at the method's order, and is one that such a step should have.
void expect_followed(const Motion& motion, const std::string& method, double amplitude) {
  const int order = facts_of(method).order;
  // As fine as what moves needs, and stable for what does not: below the limit of every method.
  const double fastest = largest_eigenfrequency(motion.system, motion.start.position);
  const int steps = static_cast<int>(
      std::ceil(motion.time * std::max(motion.frequency / resolution(order), fastest / 0.8)));
  const double coarse = error_after(motion, method, steps, fastest),
               fine = error_after(motion, method, 2 * steps, fastest);
  const double observed = std::log2(coarse / fine);
  std::printf("%s: %d steps, error %.2e of the amplitude, order %.2f\n", method.c_str(), 2 * steps,
              fine / amplitude, observed);
  const double tolerance = order > 4 ? 0.5 : order > 2 ? 0.25 : 0.15;
  EXPECT_GE(observed, order - tolerance) << method;
  const double rounding = 1e-12 * amplitude;  // an error this small may vanish faster, by luck
  if (fine > rounding) {
    EXPECT_LE(observed, order + tolerance) << method;
  }
  EXPECT_LE(fine, 0.3 * amplitude) << method;
}

/// Particles in a row, joined by a run of springs each to the next; none is pinned.
ClothSystem row_of(int count, double rest_length) {
  ClothSystem system;
  system.rows = 1;
  system.columns = count;
  const auto size = static_cast<std::size_t>(count);
  system.springs = {{SpringFamily::structural, 0, count - 1, 1, rest_length, stiffness}};
  system.mass.assign(size, mass);
  system.inverse_mass.assign(size, 1 / mass);
  system.pinned.assign(size, 0);
  system.start = Vec3Field(size);
  system.diagonal = count * length;
  return system;
}

void pin(ClothSystem& system, std::size_t particle) {
  system.pinned[particle] = 1;
  system.inverse_mass[particle] = 0;
}

Scene springs_alone() {
  Scene scene;
  scene.springs = SpringMaterial{};
  return scene;
}

TEST_P(ExactMotion, OfAMassOnASpringInACircleIsFollowed) {
  const double turn_rate = 0.5 * std::sqrt(stiffness / mass);
  const double radius = length / (1 - mass * turn_rate * turn_rate / stiffness);
  Motion orbit{.system = row_of(2, length), .scene = springs_alone()};
  pin(orbit.system, 0);
  orbit.start = starting_state(orbit.system);
  orbit.start.position.set(1, {radius, 0, 0});
  orbit.start.velocity.set(1, {0, turn_rate * radius, 0});
  orbit.time = 4 * pi / turn_rate;
  orbit.frequency = 2 * turn_rate;
  orbit.distance = [=](const ClothState& state) {
    const double angle = turn_rate * state.time;
    return (state.position[1] - radius * Vec3(std::cos(angle), std::sin(angle), 0)).norm();
  };
  expect_followed(orbit, GetParam(), radius);
}

/// A closed ring: its largest frequency of uniform expansion is w0 = 2 sin(pi/N) sqrt(k/m).
struct Ring {
  static constexpr int count = 12;
  const double own = 2 * std::sin(pi / count) * std::sqrt(stiffness / mass);
  const double rest_radius = length / (2 * std::sin(pi / count));

  static Vec3 direction(std::size_t i, double angle = 0) {
    const double at = angle + 2 * pi * static_cast<double>(i) / count;
    return {std::cos(at), std::sin(at), 0};
  }
  Motion motion(double radius, double speed_out, double turn_rate) const {
    Motion ring{.system = row_of(count, length), .scene = springs_alone()};
    ring.system.springs.push_back({SpringFamily::structural, 0, 1, count - 1, length, stiffness});
    for (std::size_t i = 0; i < count; ++i) ring.system.start.set(i, radius * direction(i));
    ring.start = starting_state(ring.system);
    for (std::size_t i = 0; i < count; ++i)
      ring.start.velocity.set(i, speed_out * direction(i) + turn_rate * radius * direction(i, pi / 2));
    return ring;
  }
};

/// The largest distance from a ring of `radius` turned by `angle`.
double distance_from_ring(const ClothState& state, double radius, double angle) {
  double largest = 0;
  for (std::size_t i = 0; i < state.position.size(); ++i)
    largest = std::max(largest, (state.position[i] - radius * Ring::direction(i, angle)).norm());
  return largest;
}

TEST_P(ExactMotion, OfASpinningRingIsFollowed) {
  const Ring ring;
  const double turn_rate = 0.5 * ring.own,
               radius = ring.rest_radius / (1 - std::pow(turn_rate / ring.own, 2));
  Motion spin = ring.motion(radius, 0, turn_rate);
  spin.time = 2 * pi / turn_rate;
  spin.frequency = 2 * ring.own;
  spin.distance = [=](const ClothState& state) {
    return distance_from_ring(state, radius, turn_rate * state.time);
  };
  expect_followed(spin, GetParam(), radius);
}

TEST_P(ExactMotion, OfAnExpandingDampedRingIsFollowed) {
  const Ring ring;
  const double c = 0.6 * ring.own, speed = 0.3 * ring.rest_radius * ring.own;
  const double damped = std::sqrt(ring.own * ring.own - c * c / 4);
  Motion wave = ring.motion(ring.rest_radius, speed, 0);
  wave.scene.damping = c * mass;
  wave.time = 0.45 * 2 * pi / damped;  // stretched all the time: a compressed ring would buckle
  wave.frequency = 2 * ring.own;
  wave.distance = [=, &ring](const ClothState& state) {
    const double t = state.time;
    return distance_from_ring(
        state, ring.rest_radius + speed / damped * std::exp(-c * t / 2) * std::sin(damped * t), 0);
  };
  expect_followed(wave, GetParam(), speed / ring.own);
}

/// m x'' = -K x - C x' + m g is linear where springs have no rest length: modes of the free particles.
class LinearCloth {
 public:
  LinearCloth(const ClothSystem& system, double damping_rate, const Vec3& gravity) : c_(damping_rate) {
    const int size = system.size();
    Eigen::MatrixXd stiff = Eigen::MatrixXd::Zero(size, size);
    for (const SpringPair& spring : springs_of(system)) {
      stiff(spring.i, spring.i) += spring.stiffness, stiff(spring.j, spring.j) += spring.stiffness;
      stiff(spring.i, spring.j) -= spring.stiffness, stiff(spring.j, spring.i) -= spring.stiffness;
    }
    for (int i = 0; i < size; ++i) (system.pinned[static_cast<std::size_t>(i)] ? pins_ : free_).push_back(i);
    Eigen::MatrixXd start(size, 3);
    for (int i = 0; i < size; ++i) start.row(i) = system.start[static_cast<std::size_t>(i)];
    const Eigen::MatrixXd inner = stiff(free_, free_) / mass;
    const Eigen::MatrixXd load = Eigen::VectorXd::Ones(inner.rows()) * gravity.transpose() -
                                 stiff(free_, pins_) / mass * start(pins_, Eigen::all);
    modes_ = symmetric_modes(inner);
    rest_ = inner.ldlt().solve(load);
    amplitudes_ = modes_.vectors.transpose() * (start(free_, Eigen::all) - rest_);
  }
  double largest_frequency() const { return std::sqrt(modes_.values.maxCoeff()); }
  /// The largest distance of a free particle from where it should be.
  double distance(const ClothState& state) const {
    Eigen::VectorXd factor(modes_.values.size());
    for (int k = 0; k < factor.size(); ++k) {
      const std::complex<double> w = std::sqrt(std::complex<double>(modes_.values[k] - c_ * c_ / 4));
      const auto swing = std::cos(w * state.time) + c_ / (2.0 * w) * std::sin(w * state.time);
      factor[k] = std::exp(-c_ * state.time / 2) * swing.real();
    }
    const Eigen::MatrixXd exact = rest_ + modes_.vectors * (factor.asDiagonal() * amplitudes_);
    double largest = 0;
    for (int k = 0; k < exact.rows(); ++k)
      largest =
          std::max(largest, (state.position[static_cast<std::size_t>(free_[static_cast<std::size_t>(k)])] -
                             exact.row(k).transpose())
                                .norm());
    return largest;
  }

 private:
  double c_;
  std::vector<int> free_, pins_;
  SymmetricModes modes_;
  Eigen::MatrixXd rest_, amplitudes_;
};

TEST_P(ExactMotion, OfAClothWithoutRestLengthsIsFollowed) {
  Scene scene = bare_sheet(6, 5, length, mass);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 20, .shear = 10, .flexion = 5, .damping = 0};
  scene.gravity = Vec3(0, -9.81, 3);
  const double c = 6;  // the slowest modes are damped above critical
  scene.damping = c * mass;
  Motion collapse{.system = make_grid(scene.cloth, *scene.springs), .scene = scene};
  for (SpringBlock& block : collapse.system.springs.blocks()) block.run.rest_length = 0;
  collapse.start = starting_state(collapse.system);
  const LinearCloth linear(collapse.system, c, *scene.gravity);
  collapse.time = 0.25;
  collapse.frequency = linear.largest_frequency();
  collapse.distance = [&](const ClothState& state) { return linear.distance(state); };
  expect_followed(collapse, GetParam(), length);
}

/// A chain of 9 free masses, stretched by a tenth between fixed ends, in its mode `mode`.
Motion chain_in_mode(int mode, const Vec3& direction, double amplitude, double spring_constant) {
  constexpr int free = 9;
  const double half_turn = pi * mode / (free + 1);
  Motion chain{.system = row_of(free + 2, length / 1.1), .scene = springs_alone()};
  pin(chain.system, 0), pin(chain.system, free + 1);
  for (std::size_t i = 0; i < free + 2; ++i)
    chain.system.start.set(i, {length * static_cast<double>(i), 0, 0});
  const double omega = 2 * std::sqrt(spring_constant / mass) * std::sin(half_turn / 2);
  const Vec3Field straight = chain.system.start;
  const auto exact = [=](std::size_t i, double t) -> Vec3 {
    return straight[i] +
           amplitude * std::sin(half_turn * static_cast<double>(i)) * std::cos(omega * t) * direction;
  };
  chain.start = starting_state(chain.system);
  for (std::size_t i = 1; i <= free; ++i) chain.start.position.set(i, exact(i, 0));
  chain.time = 1.15 * 2 * pi / omega;  // where an error of the phase shows at first order
  chain.frequency = omega;
  chain.distance = [=](const ClothState& state) {
    double largest = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i)
      largest = std::max(largest, std::abs((state.position[i] - exact(i, state.time)).dot(direction)));
    return largest;
  };
  return chain;
}

TEST_P(ExactMotion, OfAChainAlongItselfIsFollowed) {
  for (const int mode : {1, 4})
    expect_followed(chain_in_mode(mode, {1, 0, 0}, 0.1 * length, stiffness), GetParam(), 0.1 * length);
}

TEST_P(ExactMotion, OfAStretchedChainAcrossItselfIsFollowed) {
  const double amplitude = 1e-6 * length;  // the linear theory is off by 1e-11 or so of the frequency
  const double tension_over_length = stiffness * (1 - 1 / 1.1);
  for (const int mode : {6, 9})
    expect_followed(chain_in_mode(mode, {0, 0.6, 0.8}, amplitude, tension_over_length), GetParam(),
                    amplitude);
}

TEST_P(ExactMotion, OfAStretchedGridOutOfItsPlaneIsFollowed) {
  constexpr int inner = 6, p = 5, q = 6;
  const double stretch = 1.2, amplitude = 1e-6 * length;
  Scene scene = bare_sheet(inner + 2, inner + 2, length, mass);
  scene.springs = SpringMaterial{.structural = 40, .shear = 15, .flexion = 0, .damping = 0};
  scene.cloth.pins = {NamedPin::top_edge, NamedPin::bottom_edge, NamedPin::left_edge, NamedPin::right_edge};
  Motion wave{.system = make_grid(scene.cloth, *scene.springs), .scene = scene};
  for (SpringBlock& block : wave.system.springs.blocks()) block.run.rest_length /= stretch;
  const double qx = pi * p / (inner + 1), qy = pi * q / (inner + 1);
  const double omega =
      std::sqrt((1 - 1 / stretch) / mass *
                (2 * 40 * (2 - std::cos(qx) - std::cos(qy)) + 4 * 15 * (1 - std::cos(qx) * std::cos(qy))));
  const auto height = [=](int i, double t) {
    const int row = i / (inner + 2), column = i % (inner + 2);
    return amplitude * std::sin(qx * column) * std::sin(qy * row) * std::cos(omega * t);
  };
  wave.start = starting_state(wave.system);
  for (int i = 0; i < wave.system.size(); ++i)
    if (!wave.system.pinned[static_cast<std::size_t>(i)])
      wave.start.position.add(static_cast<std::size_t>(i), {0, 0, height(i, 0)});
  wave.time = 1.15 * 2 * pi / omega;
  wave.frequency = omega;
  wave.distance = [&](const ClothState& state) {
    double largest = 0;
    for (int i = 0; i < wave.system.size(); ++i)
      largest = std::max(largest,
                         std::abs(state.position[static_cast<std::size_t>(i)].z() - height(i, state.time)));
    return largest;
  };
  expect_followed(wave, GetParam(), amplitude);
}

TEST_P(ExactMotion, OfAFlatSheetInGustsIsFollowed) {  // v' = -r v + b + d sin(w t), along the sheet's normal
  const double g = 9.81, drag = 0.06, wind = 4, frequency = 2, depth = 0.8;
  Scene scene = lying_sheet(4, 4, length, mass);
  scene.springs = SpringMaterial{.structural = 2, .shear = 1, .flexion = 0.5, .damping = 0};
  scene.gravity = Vec3(0, -g, 0);
  scene.damping = 0.02;
  scene.air =
      Air{.drag = drag, .wind = {0, wind, 0}, .gust = Gust{.amplitude = depth, .frequency = frequency}};
  const double r = (drag + 0.02) / mass, b = drag * wind / mass - g, d = drag * wind * depth / mass;
  const double w = 2 * pi * frequency, common = d / (r * r + w * w);
  const auto height = [=](double t) {  // the integral of the speed that starts at 0
    const double start = -b / r + common * w;
    return b / r * t + start * (1 - std::exp(-r * t)) / r - common * r / w * (std::cos(w * t) - 1) -
           common * std::sin(w * t);
  };
  Motion gusts{.system = make_grid(scene.cloth, *scene.springs), .scene = scene};
  gusts.start = starting_state(gusts.system);
  gusts.time = 0.45;
  gusts.frequency = w + r;
  gusts.distance = [=](const ClothState& state) {
    double largest = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i)
      largest = std::max(largest, std::abs(state.position[i].y() - height(state.time)));
    return largest;
  };
  expect_followed(gusts, GetParam(), 1);
}

/// x*(t) = 1.03 X + A sin(W t) phi(X), phi = 0 on the upper edge: every spring is stretched, every normal
/// turns.
class ManufacturedMotion {
 public:
  explicit ManufacturedMotion(const ClothSystem& system) : system_(&system) {}

  Vec3Field position(double t) const { return sum(1.03, std::sin(rate * t)); }
  Vec3Field velocity(double t) const { return sum(0, rate * std::cos(rate * t)); }
  Vec3Field acceleration(double t) const { return sum(0, -rate * rate * std::sin(rate * t)); }

  static constexpr double rate = 9, amplitude = 0.12 * length;  // 1/s, m

 private:
  Vec3Field sum(double at_rest, double swing) const {
    Vec3Field result(system_->start.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      const Vec3 rest = system_->start[i] / 1.03;
      const double down = static_cast<double>(i / static_cast<std::size_t>(system_->columns));
      const double across = static_cast<double>(i % static_cast<std::size_t>(system_->columns));
      const Vec3 shape(0.4 * std::sin(0.5 * down), 0.3 * std::sin(0.4 * down) * std::cos(across),
                       std::sin(0.7 * down) * (0.6 + 0.4 * std::sin(0.9 * across)));
      result.set(i, at_rest * rest + swing * amplitude * shape);
    }
    return result;
  }
  const ClothSystem* system_;
};

/// What the motion needs beside the scene's own forces: m a* - f(x*, v*, t), a function of time alone.
class ManufacturedLoad : public Force {
 public:
  ManufacturedLoad(const Scene& scene, const ClothSystem& system) : motion_(system), own_(scene, system) {}

  void update(const ClothSystem& system, const Vec3Field&, double t, Vec3Field& force) override {
    Vec3Field needed(force.size());
    const Vec3Field position = motion_.position(t);
    own_.update(position, t);
    own_.force(position, motion_.velocity(t), needed);
    const Vec3Field acceleration = motion_.acceleration(t);
    for (std::size_t i = 0; i < force.size(); ++i) force.add(i, system.mass[i] * acceleration[i] - needed[i]);
  }

 private:
  ManufacturedMotion motion_;
  ForceModel own_;
};

TEST_P(ExactMotion, ThatWasManufacturedInWindAndDragIsFollowed) {
  Scene scene = bare_sheet(5, 4, length, mass);
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = SpringMaterial{.structural = 40, .shear = 20, .flexion = 5, .damping = 0.01};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.damping = 0.01;
  scene.air = Air{.drag = 0.05, .wind = {1, 0, 5}, .gust = Gust{.amplitude = 0.6, .frequency = 1.3}};
  Motion made{.system = make_grid(scene.cloth, *scene.springs), .scene = scene};
  for (std::size_t i = 0; i < made.system.start.size(); ++i)
    made.system.start.set(i, 1.03 * made.system.start[i]);
  const ManufacturedMotion motion(made.system);
  made.start = starting_state(made.system);
  made.start.velocity = motion.velocity(0);
  made.time = 0.5;
  made.frequency = std::sqrt(40 / mass);  // errors ring at the cloth's own frequencies
  made.distance = [&](const ClothState& state) {
    const Vec3Field exact = motion.position(state.time);
    double largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i)
      largest = std::max(largest, (state.position[i] - exact[i]).norm());
    return largest;
  };
  made.load = [&] { return std::make_unique<ManufacturedLoad>(made.scene, made.system); };
  expect_followed(made, GetParam(), ManufacturedMotion::amplitude);
}

INSTANTIATE_TEST_SUITE_P(Of, ExactMotion, ::testing::ValuesIn(integrator_names()), test_name);

}  // namespace
}  // namespace cloth::test::exact_motion_test
