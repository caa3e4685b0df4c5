// XPBD's visits of bending elements, sliders and triangles, in every instruction set that this machine has,
// against elements visited one by one in the order that kernels/projected_elements.h promises.
#include "kernels/projected_elements.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "geometry/at.h"
#include "kernels/coloured_springs.h"
#include "kernels/instruction_set.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/random.h"
#include "support/states.h"

namespace cloth::test::projected_elements_test {
namespace {

class ElementsOfEverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override { set_instruction_set(GetParam()); }
  void TearDown() override { set_instruction_set(std::nullopt); }
};
INSTANTIATE_TEST_SUITE_P(Kernels, ElementsOfEverySet, ::testing::ValuesIn(supported_instruction_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

/// Numbers of elements in the order of visits: `part` of them at a time, and of these colour after colour.
std::vector<int> order_of(const std::vector<std::vector<int>>& particles_of, std::size_t part) {
  std::vector<int> order;
  for (std::size_t first = 0; first < particles_of.size(); first += part) {
    const std::size_t end = std::min(first + part, particles_of.size());
    std::vector<int> colour(particles_of.size(), -1);
    int colours = 0;
    for (std::size_t e = first; e < end; ++e) {
      const auto shares = [&](std::size_t f) {
        for (const int i : particles_of[e])
          for (const int j : particles_of[f])
            if (i == j) return true;
        return false;
      };
      std::vector<bool> taken(end - first + 1, false);
      for (std::size_t f = first; f < e; ++f)
        if (shares(f)) taken[at(colour[f])] = true;
      while (taken[at(++colour[e])]) continue;
      colours = std::max(colours, colour[e] + 1);
    }
    for (int c = 0; c < colours; ++c)
      for (std::size_t e = first; e < end; ++e)
        if (colour[e] == c) order.push_back(static_cast<int>(e));
  }
  return order;
}

struct Case {
  double step = 2e-3;
  ProjectedElements::Times times;
  std::vector<double> mobility;
  Vec3Field drag;
  bool has_drag = false;
  SliderState sliders;

  Eigen::Matrix3d matrix(std::size_t i) const {
    Eigen::Matrix3d w = mobility[i] * Eigen::Matrix3d::Identity();
    if (has_drag) w -= drag[i] * drag[i].transpose();
    return w;
  }
};

/// From the conditions at the end of the step: of bending P = -k h (s + t ds/dt), of a slider p = -k h A
/// clamp(kappa - slip), of a triangle lambda = -h K (q + t dq/dt), q to first order in the change of a visit.
class OneByOne {
 public:
  OneByOne(const ClothSystem& system, const Case& of, const ClothState& state)
      : system_(system), of_(of), position_(state.position), velocity_(state.velocity) {
    for (const BendingRun& run : system.bending)
      for (int e = run.first; e < run.first + run.count; ++e) {
        bends_.push_back({&run, {}});
        for (int p = 0; p < run.points; ++p) bends_.back().particles.push_back(e + run.offset[at(p)]);
      }
    std::vector<std::vector<int>> of_bends, of_sliders, of_triangles;
    for (const Bend& bend : bends_) of_bends.push_back(bend.particles);
    for (const BendingSlider& s : system.sliders)
      of_sliders.emplace_back(s.particle.begin(), s.particle.begin() + s.points);
    for (const MembraneTriangle& t : system.membrane)
      of_triangles.emplace_back(t.corner.begin(), t.corner.end());
    bend_order_ = order_of(of_bends, 256), slider_order_ = order_of(of_sliders, 256);
    triangle_order_ = order_of(of_triangles, of_triangles.size() + 1);
    bend_impulse_.assign(of_bends.size(), Vec3::Zero()), slider_impulse_.assign(of_sliders.size(), 0);
    corner_impulse_.assign(of_triangles.size(), {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)});
  }

  void pass() {
    largest_ = 0;
    for (const int e : bend_order_) visit_bend(at(e));
    for (const int e : slider_order_) visit_slider(at(e));
    for (const int e : triangle_order_) visit_triangle(at(e));
  }
  const Vec3Field& velocity() const { return velocity_; }
  double largest() const { return largest_; }

 private:
  struct Bend {
    const BendingRun* run;
    std::vector<int> particles;
  };

  void push(std::size_t i, const Vec3& impulse) {
    const Vec3 change = of_.matrix(i) * impulse;
    velocity_.add(i, change);
    largest_ = std::max(largest_, change.squaredNorm());
  }

  void visit_bend(std::size_t e) {
    const Bend& bend = bends_[e];
    const double h = of_.step, k = bend.run->stiffness, both = h + of_.times.bending;
    Vec3 s = Vec3::Zero(), u = Vec3::Zero();
    Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
    for (std::size_t p = 0; p < bend.particles.size(); ++p) {
      const double c = bend.run->coefficient[p];
      const std::size_t i = at(bend.particles[p]);
      s += c * position_[i], u += c * velocity_[i], give += c * c * of_.matrix(i);
    }
    u -= give * bend_impulse_[e];
    const Vec3 next = (Eigen::Matrix3d::Identity() + k * h * both * give).lu().solve(-k * h * (s + both * u));
    for (std::size_t p = 0; p < bend.particles.size(); ++p)
      push(at(bend.particles[p]), bend.run->coefficient[p] * (next - bend_impulse_[e]));
    bend_impulse_[e] = next;
  }

  void visit_slider(std::size_t e) {
    const BendingSlider& s = system_.sliders[e];
    const Vec3 n = of_.sliders.normal[e];
    double stretch = -of_.sliders.slip[e], give = 0;
    for (std::size_t p = 0; p < at(s.points); ++p) {
      const std::size_t i = at(s.particle[p]);
      stretch += s.coefficient[p] * n.dot(position_[i] + of_.step * velocity_[i]);
      give += s.coefficient[p] * s.coefficient[p] * n.dot(of_.matrix(i) * n);
    }
    const double h = of_.step, weight = h * s.area * s.stiffness, most = h * s.area * s.yield;
    const double without = stretch - h * give * slider_impulse_[e];
    const double next = std::clamp(-weight * without / (1 + h * weight * give), -most, most);
    for (std::size_t p = 0; p < at(s.points); ++p)
      push(at(s.particle[p]), s.coefficient[p] * (next - slider_impulse_[e]) * n);
    slider_impulse_[e] = next;
  }

  void visit_triangle(std::size_t e) {
    const MembraneTriangle& t = system_.membrane[e];
    const double h = of_.step, time = of_.times.membrane;
    Eigen::Matrix<double, 3, 9> slope = Eigen::Matrix<double, 3, 9>::Zero();  // dq/dx
    Eigen::Matrix<double, 9, 9> w = Eigen::Matrix<double, 9, 9>::Zero();
    Eigen::Matrix<double, 9, 1> v, given;
    Eigen::Vector3d change;
    Eigen::Matrix3d k;
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = at(t.corner[at(c)]);
      w.block<3, 3>(3 * c, 3 * c) = of_.matrix(i);
      v.segment<3>(3 * c) = velocity_[i], given.segment<3>(3 * c) = corner_impulse_[e][at(c)];
    }
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const Vec3 d = position_[at(t.corner[at(b)])] - position_[at(t.corner[at(a)])] +
                     h * (v.segment<3>(3 * b) - v.segment<3>(3 * a));
      slope.block<1, 3>(a, 3 * a) = -2 * d.transpose(), slope.block<1, 3>(a, 3 * b) = 2 * d.transpose();
      change[a] = d.squaredNorm() - t.rest_square[at(a)];
      for (int f = 0; f < 3; ++f) k(a, f) = t.k[at(a)][at(f)];
    }
    const Eigen::Vector3d without = change - h * slope * w * given + time * slope * (v - w * given);
    const Eigen::Matrix3d matrix =
        Eigen::Matrix3d::Identity() + h * (h + time) * k * slope * w * slope.transpose();
    const Eigen::Vector3d lambda = matrix.partialPivLu().solve(Eigen::Vector3d(-h * k * without));
    const Eigen::Matrix<double, 9, 1> next = slope.transpose() * lambda;
    for (int c = 0; c < 3; ++c) {
      const Vec3 impulse = next.segment<3>(3 * c);
      push(at(t.corner[at(c)]), impulse - corner_impulse_[e][at(c)]);
      corner_impulse_[e][at(c)] = impulse;
    }
  }

  const ClothSystem& system_;
  const Case& of_;
  const Vec3Field& position_;
  Vec3Field velocity_;
  std::vector<Bend> bends_;
  std::vector<int> bend_order_, slider_order_, triangle_order_;
  std::vector<Vec3> bend_impulse_;
  std::vector<double> slider_impulse_;
  std::vector<std::array<Vec3, 3>> corner_impulse_;
  double largest_ = 0;
};

std::vector<Scene> scenes(Random& random) {
  std::vector<Scene> all;
  for (const Material& material : {any_material(), material_with_hysteresis()}) {
    all.push_back(material_sheet(12, 13, 0.02, 0.03, material));
    all.push_back(material_mesh_sheet(8, 11, 0.2, 0.3, 0.2, material, random));
  }
  return all;
}

Case case_of(const ClothSystem& system, const ClothState& state, const ProjectedElements::Times& times,
             bool has_drag, Random& random) {
  Case of{.times = times,
          .mobility = {},
          .drag = Vec3Field(system.mass.size()),
          .has_drag = has_drag,
          .sliders = sliders_at(system, state.position)};
  for (double& slip : of.sliders.slip) slip = random.normal(5);
  for (std::size_t i = 0; i < system.mass.size(); ++i) {
    of.mobility.push_back(i % 6 == 1 ? 0 : random.uniform(0.5, 1) / system.mass[i]);
    of.drag.set(i, std::sqrt(of.mobility[i] * random.uniform(0, 0.9)) * random.vector(1).normalized());
  }
  return of;
}

TEST_P(ElementsOfEverySet, AreVisitedInThePromisedOrder) {
  Random random;
  for (const Scene& scene : scenes(random))
    for (const ProjectedElements::Times times : {ProjectedElements::Times{}, {2e-3, 1e-4}})
      for (const bool has_drag : {false, true}) {
        DirectRun run(scene, "xpbd");
        const ClothState state = crumpled_state(run.system, 1e-3, 0.5, random);
        const Case of = case_of(run.system, state, times, has_drag, random);
        ClothSystem without_springs = run.system;
        without_springs.springs = SpringRuns();
        ColouredSprings particles(without_springs);
        ProjectedElements elements(run.system);
        ASSERT_TRUE(elements.suits_kernels() && particles.are_visited_by_vectors());
        OneByOne reference(run.system, of, state);
        particles.begin(of.step, {}, of.mobility), elements.begin(of.times, of.mobility);
        particles.begin_substep(state.position, state.velocity, has_drag ? &of.drag : nullptr, true);
        elements.begin_step(&of.sliders);
        for (int n = 0; n < 3; ++n) {
          particles.particles().measures = n != 1;
          reference.pass(), elements.visit(particles.particles());
          Vec3Field velocity(state.velocity.size());
          particles.give(velocity);
          const Vec3Field& expected = reference.velocity();
          EXPECT_LE(largest_distance(velocity, expected), 1e-10 * largest_distance(expected, state.velocity))
              << n;
          if (particles.particles().measures) {
            EXPECT_NEAR(particles.particles().largest_change, reference.largest(),
                        1e-8 * reference.largest());
          }
        }
        EXPECT_GT(largest_distance(reference.velocity(), state.velocity), 0.01) << "nothing moved";
      }
}

TEST(ProjectedElements, DoNotTakeATriangleWhoseStiffnessIsNegative) {
  Random random;
  DirectRun run(material_mesh_sheet(3, 3, 0.2, 0.3, 0, any_material(), random), "xpbd");
  EXPECT_TRUE(ProjectedElements(run.system).suits_kernels());
  run.system.membrane.back().k[1][1] = -1e3;
  EXPECT_FALSE(ProjectedElements(run.system).suits_kernels());
}

}  // namespace
}  // namespace cloth::test::projected_elements_test
