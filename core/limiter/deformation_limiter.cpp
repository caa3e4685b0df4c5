#include "limiter/deformation_limiter.h"

#include <algorithm>
#include <cmath>

#include "kernels/instruction_set.h"
#include "limiter/tension_springs.h"

namespace cloth {
namespace {

/// Shortens springs of which one end is pinned; otherwise as SweepKernels::shorten.
double shorten_pinned(const SpringBatch& batch, double relaxation, Points p) {
  double longest = 0;
  for (int s = 0; s < batch.row.count; ++s) {
    int still = batch.row.first + s * batch.row.stride, free = still + batch.row.offset;
    if (batch.ends == FreeEnds::first) std::swap(still, free);
    const double dx = p.x[still] - p.x[free], dy = p.y[still] - p.y[free], dz = p.z[still] - p.z[free];
    const double squared = dx * dx + dy * dy + dz * dz;
    if (!(squared > batch.limit * batch.limit)) continue;
    longest = std::max(longest, squared);
    const double length = std::sqrt(squared);
    const double share = relaxation * ((length - batch.limit) / length);
    p.x[free] += share * dx, p.y[free] += share * dy, p.z[free] += share * dz;
  }
  return longest;
}

/// As SweepKernels::longest, of a piece that is one spring, as all of a mesh are.
double length_of_one(const SpringBatch& piece, ConstPoints p) {
  const int i = piece.row.first, j = i + piece.row.offset;
  const double dx = p.x[j] - p.x[i], dy = p.y[j] - p.y[i], dz = p.z[j] - p.z[i];
  const double squared = dx * dx + dy * dy + dz * dz;
  return squared > piece.limit * piece.limit ? squared : 0;
}

double excess_of(const SpringBatch& batch, double squared_length) {
  return (std::sqrt(squared_length) - batch.limit) / batch.rest_length;
}

}  // namespace

DeformationLimiter::DeformationLimiter(const Deformation& deformation, const ClothSystem& system,
                                       bool unreachable)
    : deformation_(deformation),
      kernels_(&active_kernels<SweepKernels>()),
      pieces_(row_by_row(pieces_of(system, limited_runs(deformation, system), deformation.rate))),
      batches_(
          batches_of(pieces_of(system, limited_runs(deformation, system), deformation.rate), system.columns)),
      unreachable_(unreachable) {
  if (deformation.solver == "direct") nearest_.emplace(deformation, system);
}

bool DeformationLimiter::is_needed(const Deformation& deformation, const ClothSystem& system) {
  return std::any_of(system.springs.begin(), system.springs.end(),
                     [&](const SpringRun& run) { return is_limited(deformation, run.family); });
}

bool DeformationLimiter::has_changed(const SpringBatch& batch, std::int64_t since) const {
  for (int row = batch.low; row <= batch.high; ++row)
    if (last_move_[static_cast<std::size_t>(row)] > since) return true;
  return since < 0;
}

double DeformationLimiter::shorten(const SpringBatch& batch, double relaxation, Vec3Field& position) const {
  const Points points{position.x(), position.y(), position.z()};
  return batch.ends == FreeEnds::both ? kernels_->shorten(batch.row, batch.limit, relaxation, points)
                                      : shorten_pinned(batch, relaxation, points);
}

/// Returns the largest excess that it found. Skips batches that were within their limits and whose particles
/// have not moved since.
double DeformationLimiter::sweep(double relaxation, Vec3Field& position) {
  double largest = 0;
  for (std::size_t k = 0; k < batches_.size(); ++k) {
    const SpringBatch& batch = batches_[k];
    if (!has_changed(batch, found_still_[k])) continue;
    const double squared = shorten(batch, relaxation, position);
    if (squared > 0) {
      largest = std::max(largest, excess_of(batch, squared));
      std::fill(last_move_.begin() + batch.low, last_move_.begin() + batch.high + 1, ++moves_);
    } else {
      found_still_[k] = moves_;
    }
  }
  return largest;
}

double DeformationLimiter::excess(const Vec3Field& position) const {
  const ConstPoints points{position.x(), position.y(), position.z()};
  double largest = 0;
  for (const SpringBatch& piece : pieces_) {
    const double squared = piece.row.count == 1 ? length_of_one(piece, points)
                                                : kernels_->longest(piece.row, piece.limit, points);
    if (squared > 0) largest = std::max(largest, excess_of(piece, squared));
  }
  return largest;
}

LimiterReport DeformationLimiter::sweep_all(const ClothSystem& system, Vec3Field& position) {
  LimiterReport report;
  moves_ = 0;
  last_move_.assign(static_cast<std::size_t>(system.rows), 0);
  found_still_.assign(batches_.size(), -1);
  while (report.sweeps < deformation_.max_sweeps) {
    const double found = sweep(report.sweeps == 0 ? 1 : over_relaxation, position);
    ++report.sweeps;
    // Shortening what it found has stretched neighbours, so that the excess is measured again.
    if (accepts(found) && accepts(report.excess = excess(position))) return report;
  }
  report.excess = excess(position);
  return report;
}

LimiterReport DeformationLimiter::apply(const ClothSystem& system, double time_step, ClothState& state) {
  before_ = state.position;
  LimiterReport report;
  if (nearest_) {
    report.direct_iterations =
        nearest_->find(system, deformation_.tolerance, state.position, !unreachable_).iterations;
    report.excess = excess(state.position);
  } else {
    report = sweep_all(system, state.position);
  }
  change_velocity(system, time_step, state);
  return report;
}

void DeformationLimiter::change_velocity(const ClothSystem& system, double time_step,
                                         ClothState& state) const {
  const double per_step = 1 / time_step;
  const auto columns = static_cast<std::size_t>(system.columns);
  const auto change = [&](const double* x, const double* x0, double* v) {
    for (int row = 0; row < system.rows; ++row) {
      if (!nearest_ && last_move_[static_cast<std::size_t>(row)] == 0) continue;
      const std::size_t first = static_cast<std::size_t>(row) * columns;
      for (std::size_t k = first; k < first + columns; ++k) v[k] += (x[k] - x0[k]) * per_step;
    }
  };
  change(state.position.x(), before_.x(), state.velocity.x());
  change(state.position.y(), before_.y(), state.velocity.y());
  change(state.position.z(), before_.z(), state.velocity.z());
}

}  // namespace cloth
