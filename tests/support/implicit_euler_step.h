// The implicit Euler step of a scene of springs, their damping, viscous damping and gravity, written pair by
// pair and solved by Newton's method with a Jacobian of differences: shares no code with the engine.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"
#include "support/reference.h"

namespace cloth::test {

/// The step equations M (v' - v) = h f(x + h v', v').
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

}  // namespace cloth::test
