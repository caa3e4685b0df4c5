// The interior point method of NearestShape, on the springs that one round works on.
#pragma once

#include "limiter/nearest_shape.h"
#include "sparse/block_cholesky.h"

namespace cloth {

class InteriorPoint {
 public:
  InteriorPoint(const ClothSystem& system, std::vector<LimitedSpring> springs, const Vec3Field& start);

  /// Iterates to the minimum, at most NearestShape::most_iterations times. The shape is then `start` plus the
  /// displacements. With `reachable`, excesses are as good as forbidden; without, or where the multipliers
  /// grow beyond all that a reachable rate can need, they are only dear, and the shape is a compromise.
  NearestShapeReport solve(double tolerance, bool reachable);

  void displace(Vec3Field& position) const;
  double multiplier(std::size_t spring) const { return multiplier_[static_cast<Eigen::Index>(spring)]; }

 private:
  using Vector = Eigen::VectorXd;

  void number_particles(const ClothSystem& system);
  void start();
  void evaluate();
  bool is_minimum(double tolerance) const;
  bool has_no_shape(double tolerance) const;
  NearestShapeReport iterate(double tolerance, int most);
  bool factorise();
  void find_direction(const Vector& complementarity);
  void take_step();
  double step_length(double fraction) const;
  Vec3 difference(const Vector& of, std::size_t spring) const;
  void add_pair(Vector& to, std::size_t spring, const Vec3& amount) const;

  std::vector<LimitedSpring> springs_;
  std::vector<Vec3> rest_;             ///< x0_j - x0_i of each spring
  std::vector<int> first_, second_;    ///< unknown of each spring's ends, -1 where pinned
  std::vector<std::size_t> particle_;  ///< of each unknown
  Vector weight_;                      ///< of each unknown
  double shortest_ = 0;                ///< rest length, m
  double largest_violation_ = 0;       ///< |d| - limit at the start, m
  double rho_ = 0;                     ///< price of an excess, against weights of about 1

  Vector displacement_;          ///< x - x0, three components per unknown
  Vector slack_, multiplier_;    ///< both > 0
  std::vector<Vec3> direction_;  ///< d/|d|
  std::vector<double> length_;   ///< |d|
  Vector gap_;                   ///< |d| - limit + slack - multiplier/rho
  Vector gradient_;              ///< w (x - x0) + J^T multiplier
  double excess_ = 0;            ///< relative
  Vector stiffness_;             ///< what the eliminated slack and multiplier leave on each spring
  Vector step_, slack_step_, multiplier_step_;
  BlockCholesky factors_{3};
  std::vector<double> diagonal_, coupling_;  ///< blocks of the matrix
};

}  // namespace cloth
