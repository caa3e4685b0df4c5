// One 3-vector per particle as three contiguous runs (structure of arrays), so that kernels vectorise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>

#include "geometry/aligned.h"

namespace cloth {

using Vec3 = Eigen::Vector3d;

class Vec3Field {
 public:
  Vec3Field() = default;
  explicit Vec3Field(std::size_t size) : size_(size), data_(3 * size, 0.0) {}

  std::size_t size() const { return size_; }

  double* x() { return data_.data(); }
  double* y() { return data_.data() + size_; }
  double* z() { return data_.data() + 2 * size_; }
  const double* x() const { return data_.data(); }
  const double* y() const { return data_.data() + size_; }
  const double* z() const { return data_.data() + 2 * size_; }

  Vec3 operator[](std::size_t i) const { return {x()[i], y()[i], z()[i]}; }
  void set(std::size_t i, const Vec3& v) { x()[i] = v.x(), y()[i] = v.y(), z()[i] = v.z(); }
  void add(std::size_t i, const Vec3& v) { x()[i] += v.x(), y()[i] += v.y(), z()[i] += v.z(); }

  void fill(double value) { std::fill(data_.begin(), data_.end(), value); }

  /// All components in one run: x of every particle, then y, then z.
  std::span<double> flat() { return data_; }
  std::span<const double> flat() const { return data_; }

  bool operator==(const Vec3Field&) const = default;

 private:
  std::size_t size_ = 0;
  AlignedDoubles data_;
};

}  // namespace cloth
