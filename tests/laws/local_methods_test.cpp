// The two methods that solve the implicit Euler step by local solves: projective dynamics and XPBD.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "integrators/projective.h"
#include "integrators/xpbd.h"
#include "measure/amplification.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test {
namespace {

constexpr double g = 9.81;

IntegratorChoice projective(int iterations) {
  IntegratorChoice choice{"projective"};
  choice.projective_iterations = iterations;
  return choice;
}

IntegratorChoice xpbd(int substeps, int iterations) {
  IntegratorChoice choice{"xpbd"};
  choice.substeps = substeps;
  choice.xpbd_iterations = iterations;
  return choice;
}

// ---- the implicit Euler step
// --------------------------------------------------------------------------------

Scene hanging_cloth(double viscous, double spring_damping) {
  Scene scene = bare_sheet(5, 5, 0.1, 0.01);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 60, .shear = 30, .flexion = 10, .damping = spring_damping};
  if (viscous > 0) scene.damping = viscous;
  scene.gravity = Vec3(0, -g, 0);
  return scene;
}

/// The step equations M (v' - v) = h f(x + h v', v') of springs, their damping, viscous damping and gravity,
/// written pair by pair and solved by Newton's method with a Jacobian of differences: shares no code with the
/// engine.
class ImplicitEulerStep {
 public:
  ImplicitEulerStep(const Scene& scene, const ClothSystem& system, const ClothState& state, double h)
      : scene_(scene),
        system_(system),
        pairs_(springs_of(system)),
        x_(state.position),
        v_(state.velocity),
        h_(h) {
    for (int i = 0; i < system.size(); ++i)
      if (!system.pinned[static_cast<std::size_t>(i)]) free_.push_back(static_cast<std::size_t>(i));
  }

  Vec3Field velocity() const {
    Eigen::VectorXd unknowns = packed(v_);
    for (int n = 0; n < 30; ++n) {
      const Eigen::VectorXd r = residual(unknowns);
      Eigen::MatrixXd jacobian(r.size(), r.size());
      for (Eigen::Index k = 0; k < r.size(); ++k) {
        Eigen::VectorXd more = unknowns, less = unknowns;
        more[k] += 1e-5, less[k] -= 1e-5;
        jacobian.col(k) = (residual(more) - residual(less)) / 2e-5;
      }
      unknowns -= jacobian.partialPivLu().solve(r);
    }
    EXPECT_LE(residual(unknowns).norm(), 1e-13);
    return unpacked(unknowns);
  }

 private:
  Eigen::VectorXd packed(const Vec3Field& field) const {
    Eigen::VectorXd result(3 * static_cast<Eigen::Index>(free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k)
      result.segment<3>(3 * static_cast<Eigen::Index>(k)) = field[free_[k]];
    return result;
  }
  Vec3Field unpacked(const Eigen::VectorXd& unknowns) const {
    Vec3Field result(x_.size());
    for (std::size_t k = 0; k < free_.size(); ++k)
      result.set(free_[k], unknowns.segment<3>(3 * static_cast<Eigen::Index>(k)));
    return result;
  }
  Eigen::VectorXd residual(const Eigen::VectorXd& unknowns) const {
    const Vec3Field v = unpacked(unknowns);
    Vec3Field r(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
      r.set(i, system_.mass[i] * (v[i] - v_[i] - h_ * scene_.gravity.value_or(Vec3::Zero())) +
                   h_ * scene_.damping.value_or(0) * v[i]);
    for (const SpringPair& spring : pairs_) {
      const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
      const Vec3 between = x_[j] + h_ * v[j] - x_[i] - h_ * v[i];
      const Vec3 d = between.normalized();
      const double force = spring.stiffness * (between.norm() - spring.rest_length) +
                           scene_.springs->damping * d.dot(v[j] - v[i]);
      r.add(i, -h_ * force * d), r.add(j, h_ * force * d);
    }
    return packed(r);
  }

  const Scene& scene_;
  const ClothSystem& system_;
  std::vector<SpringPair> pairs_;
  std::vector<std::size_t> free_;
  Vec3Field x_, v_;
  double h_;
};

/// The largest distance of one step's velocities from those of implicit Euler, relative to the largest speed.
double step_error(const Scene& scene, const IntegratorChoice& choice, double h) {
  Random random;
  DirectRun run(scene, choice);
  run.state = crumpled_state(run.system, 0.01, 0.5, random);
  const Vec3Field expected = ImplicitEulerStep(scene, run.system, run.state, h).velocity();
  run.advance(1, h);
  return largest_distance(run.state.velocity, expected) / largest_norm(expected);
}

TEST(Projective, ConvergesToTheImplicitEulerStep) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  std::vector<double> errors;
  for (const int n : {5, 10, 20, 40, 80, 160, 320, 640}) {
    errors.push_back(step_error(scene, projective(n), 0.01));
    std::printf("projective %d %.3e\n", n, errors.back());
  }
}

TEST(Xpbd, ConvergesToTheImplicitEulerStep) {
  const Scene scene = hanging_cloth(0.02, 0.02);
  for (const int n : {1, 5, 10, 20, 40, 80, 160, 320, 640})
    std::printf("xpbd %d %.3e\n", n, step_error(scene, xpbd(1, n), 0.01));
}

// ---- Small Steps in Physics Simulation
// ----------------------------------------------------------------------

struct Chain {
  ClothSystem system;
  Scene scene;
};

Chain chain(double bottom_mass) {
  Chain chain;
  chain.scene.gravity = Vec3(0, -10, 0);
  chain.scene.springs = SpringMaterial{};
  ClothSystem& system = chain.system;
  system.rows = 20, system.columns = 1;
  system.mass.assign(20, 1.0);
  system.mass.back() = bottom_mass;
  system.inverse_mass.resize(20);
  system.pinned.assign(20, 0);
  system.pinned[0] = 1;
  system.start = Vec3Field(20);
  for (std::size_t i = 0; i < 20; ++i) {
    system.inverse_mass[i] = system.pinned[i] ? 0 : 1 / system.mass[i];
    system.start.set(i, Vec3(0, -0.01 * static_cast<double>(i), 0));
  }
  system.springs = {{SpringFamily::structural, 0, 19, 1, 0.01, std::numeric_limits<double>::infinity()}};
  return chain;
}

TEST(Xpbd, Chain) {
  for (auto [s, n] : {std::pair{1, 100}, {100, 1}, {1, 1}, {1, 10}, {10, 1}}) {
    Chain c = chain(1e5);
    ForceModel forces(c.scene, c.system);
    ClothState state{c.system.start, Vec3Field(20)};
    Xpbd method(s, n);
    Work work;
    double worst = 0;
    for (int f = 0; f < 1000; ++f) {
      method.step(c.system, forces, {0.03 * f, 0.03 * (f + 1), 0.03}, state, work);
      worst = std::max(worst, -state.position[19].y() - 0.19);
    }
    std::printf("%d %d worst %.5f\n", s, n, worst);
  }
  Chain c = chain(1);
  ForceModel forces(c.scene, c.system);
  ClothState state{c.system.start, Vec3Field(20)};
  Xpbd method(100, 1);
  Work work;
  for (int f = 0; f < 1000; ++f) {
    const auto before = state;
    method.step(c.system, forces, {0.03 * f, 0.03 * (f + 1), 0.03}, state, work);
    double force = 0;
    for (std::size_t i = 1; i < 20; ++i)
      force += 10 + (state.velocity[i].y() - before.velocity[i].y()) / 0.03;
    if (f % 100 == 99) std::printf("top force %.4f\n", force);
  }
}

}  // namespace
}  // namespace cloth::test
