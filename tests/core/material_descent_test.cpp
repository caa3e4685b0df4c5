// VBD's visits of particles by the kernels where a cloth has a material's bending, triangles and sliders, in
// every instruct set that this machine has, against particles visited one by one, from the definitions of the
// elements.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "geometry/at.h"
#include "kernels/instruction_set.h"
#include "kernels/mesh_descent.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/random.h"
#include "support/states.h"

namespace cloth::test::material_descent_test {
namespace {

class MaterialDescentOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, MaterialDescentOfEverySet,
                         ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

struct Damping {
  double springs = 0, stretch = 0, bending = 0, membrane = 0;  ///< N s/m, and s
};

/// The force on a particle, its stiffness and how far an element could ask for.
struct Local {
  Vec3 force = Vec3::Zero();
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  double reach = 0;
  void add_along(double k, const Vec3& n) { stiffness += k * n * n.transpose(); }
};

class OneByOne {
 public:
  OneByOne(const ClothSystem& system, const ParticleElements& elements, const Damping& damping, double step,
           const ClothState& start, const SliderState& sliders)
      : position(start.position),
        system_(system),
        elements_(elements),
        damping_(damping),
        step_(step),
        start_(start.position),
        inertial_(start.position),
        sliders_(sliders) {
    for (std::size_t i = 0; i < position.size(); ++i)
      if (!system.pinned[i]) inertial_.add(i, step * start.velocity[i]);
    position = inertial_;
  }

  void sweep() {
    for (const std::vector<int>& colour : elements_.colours())
      for (const int particle : colour) visit(at(particle));
  }
  Vec3Field position;
  int shortened = 0;  ///< visits that a reach has ended

 private:
  Vec3 velocity(std::size_t i) const { return (position[i] - start_[i]) / step_; }

  void visit(std::size_t i) {
    if (system_.pinned[i]) return;
    const double inertia = system_.mass[i] / (step_ * step_);
    const Vec3 beyond = position[i] - inertial_[i];
    Local local{.force = -inertia * beyond,
                .stiffness = inertia * Eigen::Matrix3d::Identity(),
                .reach = beyond.norm()};
    add_springs(i, local), add_bending(i, local), add_triangles(i, local), add_sliders(i, local);
    Vec3 change = local.stiffness.llt().solve(local.force);
    if (change.norm() > local.reach) change *= local.reach / change.norm(), ++shortened;
    position.add(i, change);
  }

  void add_springs(std::size_t i, Local& local) const {
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t a, std::size_t b) {
      if (!(run.stiffness > 0) || (a != i && b != i)) return;
      const std::size_t j = a == i ? b : a;
      const Vec3 d = position[j] - position[i], n = d.normalized();
      const double damper = damping_.springs + damping_.stretch * run.stiffness;
      const double tension =
          run.stiffness * (d.norm() - run.rest_length) + damper * n.dot(velocity(j) - velocity(i));
      const double across = std::max(tension / d.norm(), 0.0);
      local.force += tension * n;
      local.stiffness += across * Eigen::Matrix3d::Identity();
      local.add_along(run.stiffness + damper / step_ - across, n);
      local.reach = std::max(local.reach, d.norm() + run.rest_length);
    });
  }

  void add_bending(std::size_t i, Local& local) const {
    Vec3 force = Vec3::Zero();
    double own = 0;
    for (const BendingRun& run : system_.bending)
      for (int e = run.first; e < run.first + run.count; ++e) {
        const auto points = static_cast<std::size_t>(run.points);
        double c = 0;
        Vec3 sum = Vec3::Zero();
        for (std::size_t p = 0; p < points; ++p) {
          const std::size_t j = at(e + run.offset[p]);
          if (j == i) c = run.coefficient[p];
          sum += run.coefficient[p] * (position[j] + damping_.bending * velocity(j));
        }
        force -= run.stiffness * c * sum;
        own += run.stiffness * c * c * (1 + damping_.bending / step_);
      }
    if (own == 0) return;
    local.force += force;
    local.stiffness += own * Eigen::Matrix3d::Identity();
    local.reach = std::max(local.reach, force.norm() / own);
  }

  void add_triangles(std::size_t i, Local& local) const {
    for (const MembraneTriangle& t : system_.membrane)
      for (std::size_t c = 0; c < 3; ++c) {
        if (at(t.corner[c]) != i) continue;
        Eigen::Matrix3d k;
        Eigen::Vector3d q;
        std::array<Vec3, 3> d, by;  // edges, and dq/dx of the corner
        for (std::size_t e = 0; e < 3; ++e) {
          const std::size_t from = at(t.corner[e]), to = at(t.corner[(e + 1) % 3]);
          d[e] = position[to] - position[from];
          by[e] = from == i ? Vec3(-2 * d[e]) : to == i ? Vec3(2 * d[e]) : Vec3(0, 0, 0);
          q[static_cast<int>(e)] = d[e].squaredNorm() - t.rest_square[e] +
                                   damping_.membrane * 2 * d[e].dot(velocity(to) - velocity(from));
          for (std::size_t f = 0; f < 3; ++f) k(static_cast<int>(e), static_cast<int>(f)) = t.k[e][f];
        }
        const Eigen::Vector3d tension = k * q;
        for (std::size_t e = 0; e < 3; ++e) {
          local.force -= tension[static_cast<int>(e)] * by[e];
          for (std::size_t f = 0; f < 3; ++f)
            local.stiffness += (1 + damping_.membrane / step_) * t.k[e][f] * by[e] * by[f].transpose();
          if (by[e].isZero(0)) continue;
          local.stiffness += 2 * std::max(tension[static_cast<int>(e)], 0.0) * Eigen::Matrix3d::Identity();
          local.reach = std::max(local.reach, d[e].norm() + std::sqrt(t.rest_square[e]));
        }
      }
  }

  void add_sliders(std::size_t i, Local& local) const {
    for (std::size_t k = 0; k < system_.sliders.size(); ++k) {
      const BendingSlider& s = system_.sliders[k];
      double c = 0, stretch = -sliders_.slip[k];
      for (std::size_t p = 0; p < at(s.points); ++p) {
        if (at(s.particle[p]) == i) c = s.coefficient[p];
        stretch += s.coefficient[p] * sliders_.normal[k].dot(position[at(s.particle[p])]);
      }
      if (c == 0) continue;
      local.force -= s.area * std::clamp(s.stiffness * stretch, -s.yield, s.yield) * c * sliders_.normal[k];
      local.add_along(s.area * s.stiffness * c * c, sliders_.normal[k]);
      local.reach = std::max(local.reach, std::abs(stretch / c));
    }
  }

  const ClothSystem& system_;
  const ParticleElements& elements_;
  Damping damping_;
  double step_;
  Vec3Field start_, inertial_;
  const SliderState& sliders_;
};

std::vector<Scene> scenes(Random& random) {
  std::vector<Scene> all;
  for (const Material& material : {any_material(), material_with_hysteresis()}) {
    all.push_back(material_sheet(9, 13, 0.02, 0.03, material));
    all.push_back(material_mesh_sheet(8, 11, 0.2, 0.3, 0.2, material, random));
  }
  for (Scene& scene : all) scene.cloth.pins = {PinnedParticle{0, 0}};
  return all;
}

/// Of a crumpled cloth, `size` times as large as at rest, whose sliders have slipped, after three visits of
/// every particle: how many of them a reach has ended.
int compare(const Scene& scene, const Damping& damping, double crumple, Random& random, double size = 1) {
  DirectRun run(scene, "vbd");
  const ClothSystem& system = run.system;
  ClothState state = crumpled_state(system, crumple, 0.5, random);
  for (std::size_t i = 0; i < system.mass.size(); ++i)
    if (system.pinned[i]) state.velocity.set(i, Vec3::Zero());
  for (double& x : state.position.flat()) x *= size;
  SliderState sliders = sliders_at(system, state.position);
  for (double& slip : sliders.slip) slip = random.normal(5);
  std::vector<double> mass = system.mass;
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (system.pinned[i]) mass[i] = 0;
  ParticleElements elements(system);
  elements.list();
  MeshDescent descent(system, elements);
  constexpr double h = 2e-3;
  OneByOne reference(system, elements, damping, h, state, sliders);
  descent.begin({.step = h,
                 .mass = mass,
                 .spring_damping = damping.springs,
                 .stretch_time = damping.stretch,
                 .bending_time = damping.bending,
                 .membrane_time = damping.membrane,
                 .sliders = &sliders,
                 .position = state.position,
                 .predicted = state.velocity});
  const Vec3Field first = reference.position;
  for (int n = 0; n < 3; ++n) {
    reference.sweep(), descent.sweep();
    Vec3Field position(mass.size());
    descent.read_positions(position);
    EXPECT_LE(largest_distance(position, reference.position),
              1e-10 * largest_distance(reference.position, first));
  }
  EXPECT_GT(largest_distance(reference.position, first), 1e-5) << "nothing moved";
  return reference.shortened;
}

TEST_P(MaterialDescentOfEverySet, IsThatOfOneParticleAfterTheOther) {
  Random random;
  for (const Scene& scene : scenes(random))
    for (const Damping& damping : {Damping{}, Damping{0.01, 1e-4, 2e-3, 1e-4}, Damping{0, 0, 2e-3, 0}})
      compare(scene, damping, 1e-3, random);
}

TEST_P(MaterialDescentOfEverySet, MovesNoParticleFurtherThanAnElementWould) {
  Random random;
  int shortened = 0;
  for (const Scene& scene : scenes(random)) shortened += compare(scene, {}, 0.02, random, 0.05);
  EXPECT_GT(shortened, 0) << "no reach was asked";
}

}  // namespace
}  // namespace cloth::test::material_descent_test
