#include "support/reference.h"

#include <cmath>

#include "geometry/dense_decompositions.h"

namespace cloth::test {
namespace {

Vec3 start_of(const ClothSheet& sheet, int row, int column) {
  return sheet.origin + sheet.across.normalized() * column * sheet.width / (sheet.columns - 1) +
         sheet.down.normalized() * row * sheet.height / (sheet.rows - 1);
}

void add_pair(const Scene& scene, SpringFamily family, double stiffness, int row, int column, int other_row,
              int other_column, std::vector<SpringPair>& springs) {
  const ClothSheet& sheet = scene.cloth;
  const auto outside = [&](int r, int c) { return r < 0 || r >= sheet.rows || c < 0 || c >= sheet.columns; };
  if (!(stiffness > 0) || outside(row, column) || outside(other_row, other_column)) return;
  const double length = (start_of(sheet, row, column) - start_of(sheet, other_row, other_column)).norm();
  springs.push_back(
      {family, row * sheet.columns + column, other_row * sheet.columns + other_column, length, stiffness});
}

}  // namespace

std::vector<SpringPair> springs_by_the_table(const Scene& scene) {
  const SpringMaterial material = scene.springs.value_or(SpringMaterial{});
  std::vector<SpringPair> springs;
  for (int r = 0; r < scene.cloth.rows; ++r) {
    for (int c = 0; c < scene.cloth.columns; ++c) {
      const auto add = [&](SpringFamily family, double k, int r0, int c0, int r1, int c1) {
        add_pair(scene, family, k, r0, c0, r1, c1, springs);
      };
      add(SpringFamily::structural, material.structural, r, c, r, c + 1);
      add(SpringFamily::structural, material.structural, r, c, r + 1, c);
      add(SpringFamily::shear, material.shear, r, c, r + 1, c + 1);
      add(SpringFamily::shear, material.shear, r, c + 1, r + 1, c);
      add(SpringFamily::flexion, material.flexion, r, c, r, c + 2);
      add(SpringFamily::flexion, material.flexion, r, c, r + 2, c);
    }
  }
  return springs;
}

std::vector<SpringPair> springs_of(const ClothSystem& system) {
  std::vector<SpringPair> springs;
  for (const SpringRun& run : system.springs)
    for (int s = 0; s < run.count; ++s)
      springs.push_back(
          {run.family, run.first + s, run.first + s + run.offset, run.rest_length, run.stiffness});
  return springs;
}

Vec3Field spring_forces(const std::vector<SpringPair>& springs, const Vec3Field& position) {
  Vec3Field force(position.size());
  for (const SpringPair& spring : springs) {
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const Vec3 d = position[j] - position[i];
    if (d.norm() == 0) continue;
    const Vec3 pull = spring.stiffness * (d.norm() - spring.rest_length) * d.normalized();
    force.add(i, pull);
    force.add(j, -pull);
  }
  return force;
}

double spring_energy(const std::vector<SpringPair>& springs, const Vec3Field& position) {
  double energy = 0;
  for (const SpringPair& spring : springs) {
    const Vec3 d =
        position[static_cast<std::size_t>(spring.j)] - position[static_cast<std::size_t>(spring.i)];
    energy += 0.5 * spring.stiffness * std::pow(d.norm() - spring.rest_length, 2);
  }
  return energy;
}

double damper_product(const ClothSystem& system, double damping, const ClothState& state,
                      Vec3Field& product) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  std::vector<Long3> sums(state.position.size(), Long3::Zero());
  long double loss = 0;
  for (const SpringPair& spring : springs_of(system)) {
    const auto i = static_cast<std::size_t>(spring.i), j = static_cast<std::size_t>(spring.j);
    const Long3 d = state.position[j].cast<long double>() - state.position[i].cast<long double>();
    const Long3 u = state.velocity[j].cast<long double>() - state.velocity[i].cast<long double>();
    if (!(d.norm() > 0)) continue;
    const long double opening = u.dot(d) / d.norm();
    const Long3 on_i = damping * opening / d.norm() * d;
    sums[i] -= on_i, sums[j] += on_i;
    loss += damping * opening * opening;
  }
  product = Vec3Field(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) product.set(i, sums[i].cast<double>());
  return static_cast<double>(loss);
}

Eigen::MatrixXd spring_hessian(const ClothSystem& system, const Vec3Field& position) {
  const auto size = 3 * static_cast<Eigen::Index>(system.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (const SpringPair& spring : springs_of(system)) {
    const Vec3 d =
        position[static_cast<std::size_t>(spring.j)] - position[static_cast<std::size_t>(spring.i)];
    const Vec3 n = d.normalized();
    const Eigen::Matrix3d along = n * n.transpose();
    const Eigen::Matrix3d block = spring.stiffness * (along + (1 - spring.rest_length / d.norm()) *
                                                                  (Eigen::Matrix3d::Identity() - along));
    const Eigen::Index i = 3 * spring.i, j = 3 * spring.j;
    hessian.block<3, 3>(i, i) += block, hessian.block<3, 3>(j, j) += block;
    hessian.block<3, 3>(i, j) -= block, hessian.block<3, 3>(j, i) -= block;
  }
  return hessian;
}

double largest_eigenfrequency(const ClothSystem& system, const Vec3Field& position) {
  Eigen::MatrixXd hessian = spring_hessian(system, position);
  for (int i = 0; i < system.size(); ++i) {
    if (!system.pinned[static_cast<std::size_t>(i)]) continue;
    hessian.middleRows(3 * i, 3).setZero();
    hessian.middleCols(3 * i, 3).setZero();
  }
  return std::sqrt(symmetric_values(hessian).maxCoeff() / system.mass.front());
}

Eigen::MatrixXd damping_matrix(const ForceModel& forces, const Vec3Field& position) {
  const std::size_t particles = position.size();
  const auto size = 3 * static_cast<Eigen::Index>(particles);
  Eigen::MatrixXd matrix(size, size);
  Vec3Field velocity(particles), at_rest(particles), moving(particles);
  forces.force(position, velocity, at_rest);
  for (Eigen::Index column = 0; column < size; ++column) {
    velocity.fill(0);
    velocity.set(static_cast<std::size_t>(column / 3), Vec3::Unit(column % 3));
    forces.force(position, velocity, moving);
    matrix.col(column) = interleaved(at_rest) - interleaved(moving);
  }
  return matrix;
}

Eigen::VectorXd interleaved(const Vec3Field& field) {
  Eigen::VectorXd vector(3 * static_cast<Eigen::Index>(field.size()));
  for (std::size_t i = 0; i < field.size(); ++i)
    vector.segment<3>(3 * static_cast<Eigen::Index>(i)) = field[i];
  return vector;
}

}  // namespace cloth::test
