// The model computed again, spring by spring from (row, column) pairs as model.md lists them, sharing no code
// with the kernels.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cloth/cloth_system.h"
#include "forces/force_model.h"
#include "scene/scene.h"

namespace cloth::test {

struct SpringPair {
  SpringFamily family;
  int i, j;
  double rest_length, stiffness;
};

/// By model.md's table, from the scene.
std::vector<SpringPair> springs_by_the_table(const Scene& scene);

/// The springs that the system has, run by run.
std::vector<SpringPair> springs_of(const ClothSystem& system);

/// Spring forces in N, pair by pair.
Vec3Field spring_forces(const std::vector<SpringPair>& springs, const Vec3Field& position);
double spring_energy(const std::vector<SpringPair>& springs, const Vec3Field& position);

/// D v in N of dampers of `damping` along the springs, pair by pair in long double. Returns what they take,
/// in W.
double damper_product(const ClothSystem& system, double damping, const ClothState& state, Vec3Field& product);

/// d2E/dx2 of the springs; particle i's component a is row 3 i + a.
Eigen::MatrixXd spring_hessian(const ClothSystem& system, const Vec3Field& position);

/// The largest circular frequency of the free particles at this configuration, in 1/s.
double largest_eigenfrequency(const ClothSystem& system, const Vec3Field& position);

/// D of the forces at their last update, whose positions are `position`, column by column.
Eigen::MatrixXd damping_matrix(const ForceModel& forces, const Vec3Field& position);

Eigen::VectorXd interleaved(const Vec3Field& field);

}  // namespace cloth::test
