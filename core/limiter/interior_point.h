// The interior point method of NearestShape, on the working set of springs of one round.
#pragma once

#include "limiter/nearest_shape.h"
#include "sparse/block_cholesky.h"

namespace cloth {

class InteriorPoint {
 public:
  InteriorPoint(const ClothSystem& system, std::vector<TensionSpring> springs, const Vec3Field& start);

  /// Iterates to the minimum, at most NearestShape::max_iterations times. With `reachable` the penalty of an
  /// excess is so high that none is left; without, or where the multipliers exceed what a reachable rate can
  /// need, it is lower, and the shape is a compromise.
  NearestShapeReport solve(double tolerance, bool reachable);

  void displace(Vec3Field& position) const;
  double multiplier(std::size_t spring) const { return multiplier_[static_cast<Eigen::Index>(spring)]; }

 private:
  using Vector = Eigen::VectorXd;

  void number_particles(const ClothSystem& system);
  void start();
  void evaluate();
  bool is_minimum(double tolerance) const;
  bool is_infeasible(double tolerance) const;
  NearestShapeReport iterate(double tolerance, int most);
  bool factorise();
  void find_direction(const Vector& complementarity);
  void take_step();
  double step_length(double fraction) const;
  Vec3 difference(const Vector& of, std::size_t spring) const;
  void add_pair(Vector& to, std::size_t spring, const Vec3& amount) const;

  std::vector<TensionSpring> springs_;
  std::vector<Vec3> rest_;             ///< x0_j - x0_i of each spring
  std::vector<int> first_, second_;    ///< unknown of each spring's ends, -1 where pinned
  std::vector<std::size_t> particle_;  ///< of each unknown
  Vector weight_;                      ///< of each unknown
  double shortest_ = 0;                ///< rest length, m
  double largest_violation_ = 0;       ///< |d| - limit at the start, m
  double rho_ = 0;                     ///< penalty of an excess, for weights of about 1

  Vector displacement_;          ///< x - x0, three components per unknown
  Vector slack_, multiplier_;    ///< both > 0
  std::vector<Vec3> direction_;  ///< d/|d|
  std::vector<double> length_;   ///< |d|
  Vector gap_;                   ///< |d| - limit + slack - multiplier/rho
  Vector gradient_;              ///< w (x - x0) + J^T multiplier
  double excess_ = 0;            ///< relative
  Vector stiffness_;             ///< of each spring, after eliminating slack and multiplier
  Vector step_, slack_step_, multiplier_step_;
  BlockCholesky factors_{3};
  std::vector<double> diagonal_, coupling_;  ///< blocks of the matrix
};

}  // namespace cloth
