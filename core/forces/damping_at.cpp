#include "forces/damping_at.h"

#include <algorithm>

#include "cloth/normals.h"

namespace cloth {
namespace {

/// Whole rows in one run, or a part of each row in a run of its own.
bool fills_rows(const SpringBlock& block, int columns) {
  const int column = block.run.first % columns;
  if (block.rows == 1 && column == 0 && block.run.count % columns == 0) return true;
  return column + block.run.count <= columns && (block.rows == 1 || block.stride == columns);
}

}  // namespace

bool DampingAt::suits(const ClothSystem& system, const SweepTerms& terms) {
  return !system.is_mesh() && system.springs.blocks().size() <= directions && terms.uniform_mass &&
         std::all_of(system.springs.blocks().begin(), system.springs.blocks().end(),
                     [&](const SpringBlock& block) { return fills_rows(block, system.columns); }) &&
         !terms.has_shares && !(terms.stretch_time > 0) && !(terms.bending_time > 0) && !terms.sliders;
}

bool DampingAt::is_worthwhile(const SparseField& change) {
  return !change.is_everywhere() && change.particles().size() <= change.size() / 16;
}

DampingAt::DampingAt(const ClothSystem& system, const SweepTerms& terms) : system_(&system), terms_(&terms) {
  if (!(terms.spring_damping > 0)) return;
  for (const SpringBlock& block : system.springs.blocks())
    directions_[count_++] = direction_of(block, system.columns);
}

/// Down the columns all rows are one run.
DampingAt::Direction DampingAt::direction_of(const SpringBlock& block, int columns) {
  const SpringRun& run = block.run;
  const int row = run.first / columns, column = run.first % columns, end = run.first + run.offset;
  const int rows = std::max(block.rows, run.count / columns), width = std::min(run.count, columns);
  return {row, row + rows, column, column + width, end / columns - row, end % columns - column, run.offset};
}

Vec3 DampingAt::product(std::size_t particle, const Vec3Field& position, const Vec3Field& velocity) const {
  const int i = static_cast<int>(particle), row = i / system_->columns, column = i % system_->columns;
  const Vec3 x = position[particle], v = velocity[particle];
  Vec3 product = terms_->damping * v;
  const auto add = [&](int other) {
    const auto j = static_cast<std::size_t>(other);
    const Vec3 d = position[j] - x;
    const double square = d.squaredNorm();
    if (square > 0) product += (terms_->spring_damping * (v - velocity[j]).dot(d) / square) * d;
  };
  for (std::size_t k = 0; k < count_; ++k) {
    const Direction& way = directions_[k];
    if (way.begins_at(row, column)) add(i + way.offset);
    if (way.begins_at(row - way.down, column - way.across)) add(i - way.offset);
  }
  if (terms_->air) {
    const Vec3 n = particle_normal(system_->rows, system_->columns, position, particle);
    const double along = n.dot(v);
    product += terms_->air_drag * along * n + terms_->air_friction * (v - along * n);
  }
  return product;
}

double DampingAt::power(const Vec3Field& position, const Vec3Field& velocity,
                        const SparseField& change) const {
  double power = 0;
  const auto add = [&](std::size_t i) { power -= product(i, position, velocity).dot(change[i]); };
  if (change.is_everywhere())
    for (std::size_t i = 0; i < change.size(); ++i) add(i);
  else
    for (const std::uint32_t i : change.particles()) add(i);
  return power;
}

}  // namespace cloth
