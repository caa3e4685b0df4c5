#include "kernels/grid_descent.h"

#include <algorithm>
#include <cmath>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int residues = 5, widest = 8;

}  // namespace

bool GridDescent::suits(const kernels::Grid& grid) {
  return std::all_of(std::begin(grid.kind), std::end(grid.kind),
                     [](const auto& kind) { return std::isfinite(kind.rest_tension); });
}

GridDescent::GridDescent(const kernels::Grid& grid) : kernels_(&active_kernels<kernels::GridKernels>()) {
  descent_.grid = grid;
  for (int k = 0; k < kernels::spring_kinds; ++k)
    if (grid.kind[k].stiffness > 0)
      descent_.rest_length[k] = grid.kind[k].rest_tension / grid.kind[k].stiffness;
  const int longest = (grid.columns + residues - 1) / residues;
  descent_.residue_stride = (longest + widest - 1) / widest * widest + widest;
  descent_.row_stride = residues * descent_.residue_stride;
  if (descent_.row_stride % 512 == 0) descent_.row_stride += widest;  // rows not all in one place of a cache
  descent_.first = widest;

  const auto size = static_cast<std::size_t>(descent_.place(grid.rows, 0, 0) + widest);
  mass_.assign(size, 1.0), free_.assign(size, 0.0);
  there_.assign(static_cast<std::size_t>(descent_.row_stride + 2 * widest), 0.0);
  for (int column = 0; column < grid.columns; ++column)
    there_[static_cast<std::size_t>(descent_.first + column % residues * descent_.residue_stride +
                                    column / residues)] = 1;
  descent_.there = there_.data() + descent_.first;
  descent_.mass = mass_.data(), descent_.free = free_.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (Stored* field : {&position_, &shift_}) (*field)[axis].assign(size, 0.0);
    descent_.position[axis] = position_[axis].data(), descent_.shift[axis] = shift_[axis].data();
  }
}

/// visit(particle, place)
template <class Visit>
void GridDescent::for_each_particle(const Visit& visit) const {
  std::size_t row_begin = 0;
  for (int row = 0; row < descent_.grid.rows; ++row) {
    for (int residue = 0; residue < residues; ++residue) {
      auto place = static_cast<std::size_t>(descent_.place(row, residue, 0));
      for (int column = residue; column < descent_.grid.columns; column += residues, ++place)
        visit(row_begin + static_cast<std::size_t>(column), place);
    }
    row_begin += static_cast<std::size_t>(descent_.grid.columns);
  }
}

void GridDescent::store(const Vec3Field& field, Stored& to) const {
  const double* const from[] = {field.x(), field.y(), field.z()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    to[axis].resize(mass_.size());
    for_each_particle(
        [f = from[axis], t = to[axis].data()](std::size_t i, std::size_t place) { t[place] = f[i]; });
  }
}

void GridDescent::begin(double step, const std::vector<double>& mass, double spring_damping,
                        const Vec3Field& start, const Vec3Field& predicted, bool extrapolates) {
  step_ = step;
  const double over_square = 1 / (step * step);
  for_each_particle([&](std::size_t i, std::size_t place) {
    free_[place] = mass[i] > 0 ? 1 : 0;
    mass_[place] = mass[i] > 0 ? mass[i] * over_square : 1;
  });
  Vec3Field inertial = start;
  const auto to = inertial.flat();
  const auto from = predicted.flat();
  for (std::size_t k = 0; k < to.size(); ++k) to[k] += step * from[k];
  store(inertial, position_);
  descent_.damper = spring_damping / step;
  if (spring_damping > 0) store(start, start_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill(shift_[axis].begin(), shift_[axis].end(), 0.0);
    descent_.start[axis] = spring_damping > 0 ? start_[axis].data() : nullptr;
    if (extrapolates) before_[axis].assign(mass_.size(), 0.0), present_[axis].assign(mass_.size(), 0.0);
    descent_.before[axis] = extrapolates ? before_[axis].data() : nullptr;
  }
}

GridDescent::Sums GridDescent::sweep() {
  if (descent_.before[0])
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::copy(shift_[axis].begin(), shift_[axis].end(), present_[axis].begin());
  kernels_->descend(descent_);
  const double square = step_ * step_;
  return {descent_.largest_change / square, descent_.squares / square};
}

void GridDescent::extrapolate(double weight) {
  if (weight > 1) kernels_->extrapolate(descent_, weight);
  std::swap(before_, present_);
  for (std::size_t axis = 0; axis < 3; ++axis) descent_.before[axis] = before_[axis].data();
}

void GridDescent::end(Vec3Field& velocity) const {
  double* const to[] = {velocity.x(), velocity.y(), velocity.z()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for_each_particle([&, t = to[axis], u = shift_[axis].data()](std::size_t i, std::size_t place) {
      t[i] += u[place] / step_;
    });
}

}  // namespace cloth
