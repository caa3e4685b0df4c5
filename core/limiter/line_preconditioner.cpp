#include "limiter/line_preconditioner.h"

namespace cloth {

LinePreconditioner::LinePreconditioner(GridEquations& equations, const TensionKernels& kernels)
    : equations_(equations), kernels_(kernels) {
  const GridPlan& plan = equations.plan;
  const std::size_t line = static_cast<std::size_t>(plan.stride) * lanes_of_rows;
  const std::size_t blocks = static_cast<std::size_t>((plan.rows + lanes_of_rows - 1) / lanes_of_rows);
  for (const FamilyEquations& family : equations.families) {
    const std::size_t size = family.is_row() ? blocks * line : plan.size();
    factors_.push_back({AlignedFloats(size, 0.0f), AlignedFloats(size, 0.0f)});
  }
  zero_.assign(line, 0.0f);
  weight_.assign(blocks * line, 0.0f);
  for (AlignedFloats* field : {&x_, &y_, &z_, &scratch_}) field->assign(line, 0.0f);
}

void LinePreconditioner::take_weights() {
  const GridPlan& plan = equations_.plan;
  for (int first = 0; first < plan.rows; first += lanes_of_rows)
    kernels_.floats_into_lanes(equations_.weight.data() + plan.index(first, 0), plan.stride,
                               std::min(lanes_of_rows, plan.rows - first), plan.columns,
                               weight_.data() + static_cast<std::ptrdiff_t>(first) * plan.stride);
}

void LinePreconditioner::factorise(double ridge) {
  for (std::size_t f = 0; f < factors_.size(); ++f)
    if (equations_.families[f].is_row())
      factorise_rows(f, ridge);
    else
      factorise_columns(f, ridge);
}

FactorRow LinePreconditioner::row_at(std::size_t f, std::ptrdiff_t i) {
  const FamilyEquations& family = equations_.families[f];
  const float* weight = equations_.weight.data() + i;
  return {family.ax.data() + i,   family.ay.data() + i,        family.az.data() + i,        weight,
          weight + family.offset, factors_[f].link.data() + i, factors_[f].pivot.data() + i};
}

void LinePreconditioner::factorise_columns(std::size_t f, double ridge) {
  const FamilyEquations& family = equations_.families[f];
  const RowInterval rows = family.rows_within(equations_.active);
  float* zero = zero_.data();
  for (int row = rows.begin; row < rows.end; ++row) {
    const std::ptrdiff_t i = equations_.plan.index(row, family.plan.begin);
    const bool first = row - family.plan.down < rows.begin;
    const FactorRow none{zero, zero, zero, zero, zero, nullptr, zero};
    kernels_.factorise_row(row_at(f, i), first ? none : row_at(f, i - family.offset), ridge,
                           family.plan.width());
  }
}

/// The springs of a row one after the other, rows side by side.
void LinePreconditioner::factorise_rows(std::size_t f, double ridge) {
  const FamilyEquations& family = equations_.families[f];
  const GridPlan& plan = equations_.plan;
  const RowInterval rows = family.rows_within(equations_.active);
  const int across = family.plan.across;
  for (int first = first_of_lanes(rows.begin); first < rows.end; first += lanes_of_rows) {
    const int count = std::min(lanes_of_rows, plan.rows - first);
    const std::ptrdiff_t i = plan.index(first, 0);
    const auto load = [&](const AlignedFloats& from, AlignedFloats& to) {
      kernels_.floats_into_lanes(from.data() + i, plan.stride, count, plan.columns, to.data());
    };
    load(family.ax, x_), load(family.ay, y_), load(family.az, z_);
    const std::ptrdiff_t block = static_cast<std::ptrdiff_t>(first) * plan.stride;
    for (int c = 0; c < family.plan.end; ++c) {
      const auto at = [&](int column) {
        const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(column) * lanes_of_rows;
        const float* weight = weight_.data() + block + k;
        return FactorRow{x_.data() + k,
                         y_.data() + k,
                         z_.data() + k,
                         weight,
                         weight + across * lanes_of_rows,
                         factors_[f].link.data() + block + k,
                         factors_[f].pivot.data() + block + k};
      };
      float* zero = zero_.data();
      const FactorRow none{zero, zero, zero, zero, zero, nullptr, zero};
      kernels_.factorise_row(at(c), c < across ? none : at(c - across), ridge, lanes_of_rows);
    }
  }
}

void LinePreconditioner::solve_rows(std::size_t f, int first) {
  FamilyEquations& family = equations_.families[f];
  const GridPlan& plan = equations_.plan;
  const std::ptrdiff_t i = plan.index(first, 0), block = static_cast<std::ptrdiff_t>(first) * plan.stride;
  kernels_.solve_lanes({factors_[f].link.data() + block, factors_[f].pivot.data() + block, scratch_.data()},
                       family.residual.data() + i, plan.stride, std::min(lanes_of_rows, plan.rows - first),
                       family.plan.end, family.plan.across, family.solved.data() + i);
}

void LinePreconditioner::eliminate(std::size_t f, int row) {
  FamilyEquations& family = equations_.families[f];
  const RowInterval rows = family.rows_within(equations_.active);
  if (row < rows.begin || row >= rows.end) return;
  if (family.is_row()) {
    if ((row + 1) % lanes_of_rows == 0 || row + 1 == rows.end) solve_rows(f, first_of_lanes(row));
    return;
  }
  const std::ptrdiff_t i = equations_.plan.index(row, family.plan.begin);
  const bool first = row - family.plan.down < rows.begin;
  kernels_.eliminate_row(family.residual.data() + i, factors_[f].link.data() + i,
                         factors_[f].pivot.data() + i,
                         first ? zero_.data() : family.solved.data() + i - family.offset,
                         family.solved.data() + i, family.plan.width());
}

double LinePreconditioner::substitute() {
  double product = 0;
  for (int row = equations_.active.end; row-- > equations_.active.begin;)
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      FamilyEquations& family = equations_.families[f];
      const RowInterval rows = family.rows_within(equations_.active);
      if (row >= rows.end) continue;
      const std::ptrdiff_t i = equations_.plan.index(row, family.plan.begin);
      if (!family.is_row() && row + family.plan.down < rows.end) {
        const std::ptrdiff_t next = i + family.offset;
        kernels_.substitute_row(factors_[f].pivot.data() + i, factors_[f].link.data() + next,
                                family.solved.data() + next, family.solved.data() + i, family.plan.width());
      }
      product += kernels_.dot_row(family.residual.data() + i, family.solved.data() + i, family.plan.width());
    }
  return product;
}

}  // namespace cloth
