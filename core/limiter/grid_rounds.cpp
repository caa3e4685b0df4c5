#include "limiter/grid_rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int lines_in_lanes = 128;  ///< columns or diagonals at most: what the cache holds
constexpr int max_terms = 16;        ///< springs of a particle, in twelve directions

GridEquations equations_of(const GridPlan& plan) {
  GridEquations equations{
      .plan = plan, .families = {}, .weight = AlignedFloats(plan.size(), 0.0f), .active = {}};
  for (const GridFamily& member : plan.families) {
    FamilyEquations& family = equations.families.emplace_back();
    family.plan = member;
    family.offset = plan.offset(member);
    family.tension.assign(plan.size(), 0.0);
    for (AlignedFloats* field : {&family.ax, &family.ay, &family.az, &family.over, &family.change,
                                 &family.residual, &family.solved, &family.direction, &family.product})
      field->assign(plan.size(), 0.0f);
    family.lengths.resize(static_cast<std::size_t>(member.rows));
    family.residuals.resize(static_cast<std::size_t>(member.rows));
  }
  return equations;
}

}  // namespace

GridRounds::GridRounds(const GridPlan& plan)
    : equations_(equations_of(plan)),
      kernels_(active_kernels<TensionKernels>()),
      preconditioner_(equations_, kernels_),
      shortest_(std::numeric_limits<double>::infinity()) {
  const std::size_t size = plan.size(), line = static_cast<std::size_t>(plan.stride) * lanes_of_rows;
  const std::size_t blocks = static_cast<std::size_t>((plan.rows + lanes_of_rows - 1) / lanes_of_rows);
  for (const GridFamily& family : plan.families) shortest_ = std::min(shortest_, family.rest_length);
  for (AlignedDoubles* field : {&x_, &y_, &z_, &weight_}) field->assign(size, 0.0);
  for (AlignedFloats* field : {&sx_, &sy_, &sz_}) field->assign(size, 0.0f);
  for (AlignedDoubles* field : {&lanes_x_, &lanes_y_, &lanes_z_, &lanes_}) field->assign(line, 0.0);
  lanes_weight_.assign(blocks * line, 0.0);
}

/// Does nothing where they are the same as in the last call, as nearly always.
void GridRounds::take_weights(const std::vector<double>& inverse_mass) {
  if (inverse_mass == inverse_mass_) return;
  inverse_mass_ = inverse_mass;
  const double largest = *std::max_element(inverse_mass.begin(), inverse_mass.end());
  const double per_largest = largest > 0 ? 1 / largest : 0;
  for (int row = 0; row < plan_.rows; ++row)
    for (int column = 0; column < plan_.columns; ++column) {
      const auto i = static_cast<std::size_t>(plan_.index(row, column));
      weight_[i] =
          per_largest * inverse_mass[static_cast<std::size_t>(row) * static_cast<std::size_t>(plan_.columns) +
                                     static_cast<std::size_t>(column)];
      equations_.weight[i] = static_cast<float>(weight_[i]);
    }
  for (FamilyEquations& family : equations_.families) {
    family.pins.assign(static_cast<std::size_t>(family.plan.rows), 0);
    for (int row = 0; row < family.plan.rows; ++row)
      for (int column = family.plan.begin; column < family.plan.end; ++column) {
        const std::ptrdiff_t i = plan_.index(row, column);
        const bool pins = !(
            weight_[static_cast<std::size_t>(i)] + weight_[static_cast<std::size_t>(i + family.offset)] > 0);
        family.pins[static_cast<std::size_t>(row)] |= static_cast<std::uint8_t>(pins);
      }
  }
  for (int first = 0; first < plan_.rows; first += lanes_of_rows)
    kernels_.doubles_into_lanes(weight_.data() + plan_.index(first, 0), plan_.stride,
                                std::min(lanes_of_rows, plan_.rows - first), plan_.columns,
                                lanes_weight_.data() + static_cast<std::ptrdiff_t>(first) * plan_.stride);
  preconditioner_.take_weights();
}

void GridRounds::begin(const TensionTask& task, const TensionProblem& problem) {
  task_ = task;
  tension_ = &problem.tension, position_ = &problem.position;
  const std::vector<double>&tension = tension_->values(), &inverse_mass = problem.inverse_mass;
  const Vec3Field& position = *position_;
  if (!problem.from.is_everywhere()) problem.from.everywhere() = position;
  take_weights(inverse_mass);
  const double largest = *std::max_element(inverse_mass.begin(), inverse_mass.end());
  unit_ = task.time_step * task.time_step * (largest > 0 ? largest : 1);
  const double* from[] = {position.x(), position.y(), position.z()};
  AlignedDoubles* to[] = {&x_, &y_, &z_};
  for (int row = 0; row < plan_.rows; ++row)
    for (int k = 0; k < 3; ++k)
      std::copy_n(from[k] + static_cast<std::ptrdiff_t>(row) * plan_.columns, plan_.columns,
                  to[k]->data() + plan_.index(row, 0));
  for (FamilyEquations& family : equations_.families)
    for (int row = 0; row < family.plan.rows; ++row) {
      const int width = family.plan.width();
      const double* there =
          tension.data() + family.plan.first_spring + static_cast<std::ptrdiff_t>(row) * width;
      double* here = family.tension.data() + plan_.index(row, family.plan.begin);
      for (int c = 0; c < width; ++c) here[c] = unit_ * there[c];
    }
  moved_ = {0, plan_.rows};
}

void GridRounds::end(bool changed) {
  if (!changed) return;
  std::vector<double>& tension = tension_->write();
  Vec3Field& position = *position_;
  const AlignedDoubles* from[] = {&x_, &y_, &z_};
  double* to[] = {position.x(), position.y(), position.z()};
  for (int row = 0; row < plan_.rows; ++row)
    for (int k = 0; k < 3; ++k)
      std::copy_n(from[k]->data() + plan_.index(row, 0), plan_.columns,
                  to[k] + static_cast<std::ptrdiff_t>(row) * plan_.columns);
  for (const FamilyEquations& family : equations_.families)
    for (int row = 0; row < family.plan.rows; ++row) {
      const double* here = family.tension.data() + plan_.index(row, family.plan.begin);
      const int width = family.plan.width();
      double* there = tension.data() + family.plan.first_spring + static_cast<std::ptrdiff_t>(row) * width;
      for (int c = 0; c < width; ++c) there[c] = here[c] / unit_;
    }
  tension_->list_held();
}

GridNodes GridRounds::nodes() {
  return {x_.data(), y_.data(), z_.data(), weight_.data()};
}

SpringRule GridRounds::rule_of(const FamilyEquations& family) const {
  return {family.plan.limit, task_.softness, least_ridge};
}

void GridRounds::evaluate_row(FamilyEquations& family, int row) {
  const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
  kernels_.evaluate_row(nodes(), i, family.offset, family.tension.data() + i, family.plan.width(),
                        rule_of(family),
                        {family.ax.data() + i, family.ay.data() + i, family.az.data() + i,
                         family.over.data() + i, family.residual.data() + i});
}

void GridRounds::measure_row(FamilyEquations& family, int row) {
  const auto r = static_cast<std::size_t>(row);
  const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
  const double* tension = family.tension.data() + i;
  if (task_.softness > 0) {
    evaluate_row(family, row);
    family.residuals[r] = kernels_.residual_row(tension, family.over.data() + i, family.plan.width());
  } else {
    family.lengths[r] =
        kernels_.measure_row(nodes(), i, family.offset, tension, family.plan.width(), family.pins[r] != 0);
  }
}

bool GridRounds::is_active(const FamilyEquations& family, int row) const {
  const auto r = static_cast<std::size_t>(row);
  if (task_.softness > 0) return family.residuals[r].active;
  const RowLengths& found = family.lengths[r];
  return found.longest > family.plan.limit * family.plan.limit ||
         found.shortest < std::numeric_limits<double>::infinity();
}

TensionResidual GridRounds::evaluate() {
  TensionResidual found;
  equations_.active = {plan_.rows, 0};
  for (FamilyEquations& family : equations_.families) {
    const RowInterval changed = family.rows_within({moved_.begin - family.plan.down, moved_.end});
    for (int row = changed.begin; row < changed.end; ++row) measure_row(family, row);
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    RowResidual soft;
    for (int row = 0; row < family.plan.rows; ++row) {
      const auto r = static_cast<std::size_t>(row);
      if (!is_active(family, row)) continue;
      equations_.active.begin = std::min(equations_.active.begin, row);
      equations_.active.end = std::max(equations_.active.end, row + 1);
      longest = std::max(longest, family.lengths[r].longest);
      shortest = std::min(shortest, family.lengths[r].shortest);
      soft.over = std::max(soft.over, family.residuals[r].over);
      soft.slack = std::max(soft.slack, family.residuals[r].slack);
    }
    if (!(task_.softness > 0)) {
      soft.over = std::sqrt(longest) - family.plan.limit;
      soft.slack = family.plan.limit - std::sqrt(shortest);
    }
    found.excess = std::max(found.excess, soft.over / family.plan.rest_length);
    found.slack = std::max(found.slack, soft.slack / family.plan.rest_length);
  }
  moved_ = {plan_.rows, 0};
  return found;
}

void GridRounds::sweep_lines(bool backwards) {
  if (equations_.active.is_empty()) return;
  for (std::size_t k = 0; k < equations_.families.size(); ++k) {
    FamilyEquations& family = equations_.families[backwards ? equations_.families.size() - 1 - k : k];
    if (family.is_row())
      sweep_rows(family);
    else
      sweep_columns(family);
  }
  moved_ = {std::min(moved_.begin, equations_.active.begin - 1),
            std::max(moved_.end, equations_.active.end + 1 + plan_.padding)};
}

void GridRounds::sweep(const LineBlock& block, const FamilyEquations& family) {
  const std::size_t size = static_cast<std::size_t>(block.count + 2) * static_cast<std::size_t>(block.lanes);
  for (AlignedFloats& field : line_scratch_)
    if (field.size() < size) field.resize(size);
  auto& [ax, ay, az, link, pivot, step] = line_scratch_;
  kernels_.sweep_block(block, rule_of(family),
                       {ax.data(), ay.data(), az.data(), link.data(), pivot.data(), step.data()});
}

void GridRounds::sweep_rows(FamilyEquations& family) {
  const RowInterval rows = family.rows_within({equations_.active.begin - 1, equations_.active.end + 1});
  const int columns = plan_.columns, across = family.plan.across;
  for (int first = first_of_lanes(rows.begin); first < rows.end; first += lanes_of_rows) {
    const int count = std::min(lanes_of_rows, plan_.rows - first);
    const std::ptrdiff_t i = plan_.index(first, 0);
    const auto load = [&](const AlignedDoubles& from, AlignedDoubles& to) {
      kernels_.doubles_into_lanes(from.data() + i, plan_.stride, count, columns, to.data());
    };
    load(x_, lanes_x_), load(y_, lanes_y_), load(z_, lanes_z_);
    load(family.tension, lanes_);
    for (int start = 0; start < across; ++start) {
      const LineBlock block{
          .nodes = {lanes_x_.data(), lanes_y_.data(), lanes_z_.data(),
                    lanes_weight_.data() + static_cast<std::ptrdiff_t>(first) * plan_.stride},
          .tension = lanes_.data(),
          .first = start * lanes_of_rows,
          .step = across * lanes_of_rows,
          .count = (columns - 1 - start) / across,
          .lanes = lanes_of_rows,
          .begin = 0,
          .end = lanes_of_rows,
          .shift = 0};
      sweep(block, family);
    }
    const auto keep = [&](const AlignedDoubles& from, AlignedDoubles& to) {
      kernels_.doubles_out_of_lanes(from.data(), plan_.stride, count, columns, to.data() + i);
    };
    keep(lanes_x_, x_), keep(lanes_y_, y_), keep(lanes_z_, z_), keep(lanes_, family.tension);
  }
}

void GridRounds::sweep_columns(FamilyEquations& family) {
  const RowInterval rows = family.rows_within({equations_.active.begin - 1, equations_.active.end + 1});
  for (int start = rows.begin; start < std::min(rows.begin + family.plan.down, rows.end); ++start) {
    const int count = (rows.end - start - 1) / family.plan.down + 1;
    // A line is identified by the column at which it crosses the row `start`.
    const int across = family.plan.across, drift = (count - 1) * across;
    const int low = family.plan.begin - std::max(0, drift), high = family.plan.end - std::min(0, drift);

    for (int column = low; column < high; column += lines_in_lanes) {
      const LineBlock block{.nodes = nodes(),
                            .tension = family.tension.data(),
                            .first = plan_.index(start, column),
                            .step = family.offset,
                            .count = count,
                            .lanes = std::min(lines_in_lanes, high - column),
                            .begin = family.plan.begin - column,
                            .end = family.plan.end - column,
                            .shift = across};
      sweep(block, family);
    }
  }
}

void GridRounds::find_equations() {
  for (FamilyEquations& family : equations_.families) {
    const RowInterval rows = family.rows_within(equations_.active);
    for (int row = rows.begin; row < rows.end; ++row) {
      evaluate_row(family, row);
      std::fill_n(family.change.data() + plan_.index(row, family.plan.begin), family.plan.width(), 0.0f);
    }
  }
}

/// The springs that begin or end at a row of particles. Returns how many families they are of.
int GridRounds::springs_at(int row, Values value, SpringTerm* terms) const {
  int count = 0;
  const std::ptrdiff_t i = plan_.index(row, 0);
  for (const FamilyEquations& family : equations_.families) {
    const RowInterval rows = family.rows_within(equations_.active);
    const auto add = [&](std::ptrdiff_t k, float sign) {
      terms[count++] = {family.ax.data() + k, family.ay.data() + k, family.az.data() + k,
                        (family.*value).data() + k, sign};
    };
    if (row >= rows.begin && row < rows.end) add(i, 1);
    const int above = row - family.plan.down;
    if (above >= rows.begin && above < rows.end) add(i - family.offset, -1);
  }
  return count;
}

/// product <- (J W J^T + ridge diagonal) value, row by row as the particles' rows become known. Returns
/// value . product.
double GridRounds::multiply(Values value, double ridge) {
  double dot = 0;
  const int end = std::min(plan_.rows, equations_.active.end + plan_.padding);
  for (int row = equations_.active.begin; row < end; ++row) {
    SpringTerm terms[max_terms];
    const std::ptrdiff_t r = plan_.index(row, 0);
    if (const int count = springs_at(row, value, terms); count > 0)
      kernels_.transpose_row(terms, count, equations_.weight.data() + r, sx_.data() + r, sy_.data() + r,
                             sz_.data() + r, plan_.columns);
    for (FamilyEquations& family : equations_.families) {
      const RowInterval rows = family.rows_within(equations_.active);
      const int begins = row - family.plan.down;
      if (begins < rows.begin || begins >= rows.end) continue;
      const std::ptrdiff_t i = plan_.index(begins, family.plan.begin);
      dot += kernels_.matrix_row({family.ax.data() + i, family.ay.data() + i, family.az.data() + i,
                                  (family.*value).data() + i, equations_.weight.data() + i, sx_.data() + i,
                                  sy_.data() + i, sz_.data() + i, family.product.data() + i},
                                 family.offset, ridge, family.plan.width());
    }
  }
  return dot;
}

/// Returns the largest residual that is left.
double GridRounds::advance(double length) {
  float largest = 0;
  for (int row = equations_.active.begin; row < equations_.active.end; ++row)
    for (std::size_t f = 0; f < equations_.families.size(); ++f) {
      FamilyEquations& family = equations_.families[f];
      if (row >= family.plan.rows) continue;
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      largest =
          std::max(largest, kernels_.solution_row(static_cast<float>(length), family.direction.data() + i,
                                                  family.product.data() + i, family.change.data() + i,
                                                  family.residual.data() + i, family.plan.width()));
      preconditioner_.eliminate(f, row);
    }
  return largest;
}

int GridRounds::conjugate_gradients() {
  const double ridge = ridge_of(task_);
  float largest = 0;
  for (int row = equations_.active.begin; row < equations_.active.end; ++row)
    for (std::size_t f = 0; f < equations_.families.size(); ++f) {
      FamilyEquations& family = equations_.families[f];
      if (row >= family.plan.rows) continue;
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      largest = std::max(largest, kernels_.largest_row(family.residual.data() + i, family.plan.width()));
      preconditioner_.eliminate(f, row);
    }
  const double enough =
      std::max(enough_of_residual * largest, enough_of_tolerance * task_.tolerance * shortest_);
  double product = preconditioner_.substitute(), share = 0;
  int iterations = 0;
  while (iterations < max_cg_iterations && product > 0) {
    for (int row = equations_.active.begin; row < equations_.active.end; ++row)
      for (FamilyEquations& family : equations_.families) {
        if (row >= family.plan.rows) continue;
        const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
        if (iterations == 0)
          std::copy_n(family.solved.data() + i, family.plan.width(), family.direction.data() + i);
        else
          kernels_.direction_row(family.solved.data() + i, static_cast<float>(share),
                                 family.direction.data() + i, family.plan.width());
      }
    const double length = product / multiply(&FamilyEquations::direction, ridge);
    ++iterations;
    if (advance(length) <= enough) break;
    const double next = preconditioner_.substitute();
    share = next / product;
    product = next;
  }
  return iterations;
}

template <class Visit>
void GridRounds::each_active_row(const Visit& visit) {
  for (FamilyEquations& family : equations_.families) {
    const RowInterval rows = family.rows_within(equations_.active);
    for (int row = rows.begin; row < rows.end; ++row) visit(family, plan_.index(row, family.plan.begin));
  }
}

/// Clips the changes so that tensions stay at least 0. Returns how much of the clipped step to take: as long
/// as it reduces C; 0 where no length of it does.
double GridRounds::clip_step() {
  bool clipped = false;
  double gain = 0;
  each_active_row([&](FamilyEquations& family, std::ptrdiff_t i) {
    const ClippedRow found = kernels_.clip_row(family.tension.data() + i, family.over.data() + i,
                                               family.change.data() + i, family.plan.width());
    gain += found.gain;
    clipped = clipped || found.clipped;
  });
  if (!clipped) return 1;
  return gain > 0 ? std::min(1.0, gain / multiply(&FamilyEquations::change, task_.softness)) : 0;
}

void GridRounds::take_step() {
  double length = clip_step();
  if (!(length > 0)) {
    length = 1;
    each_active_row([&](FamilyEquations& family, std::ptrdiff_t i) {
      const float* weight = equations_.weight.data() + i;
      kernels_.steepest_row(static_cast<float>(steepest_share), family.over.data() + i, weight,
                            weight + family.offset, family.tension.data() + i, family.change.data() + i,
                            family.plan.width());
    });
  }
  each_active_row([&](FamilyEquations& family, std::ptrdiff_t i) {
    kernels_.add_row(length, family.change.data() + i, family.tension.data() + i, family.plan.width());
  });
  move_particles(length);
}

void GridRounds::move_particles(double length) {
  const int end = std::min(plan_.rows, equations_.active.end + plan_.padding);
  for (int row = equations_.active.begin; row < end; ++row) {
    SpringTerm terms[max_terms];
    const int count = springs_at(row, &FamilyEquations::change, terms);
    const std::ptrdiff_t i = plan_.index(row, 0);
    kernels_.move_row(terms, count, length, weight_.data() + i, x_.data() + i, y_.data() + i, z_.data() + i,
                      plan_.columns);
  }
  moved_ = {std::min(moved_.begin, equations_.active.begin), std::max(moved_.end, end)};
}

int GridRounds::solve_together() {
  if (equations_.active.is_empty()) return 0;
  find_equations();
  preconditioner_.factorise(ridge_of(task_));
  const int iterations = conjugate_gradients();
  take_step();
  return iterations;
}

std::unique_ptr<TensionRounds> make_grid_rounds(const GridPlan& plan) {
  return std::make_unique<GridRounds>(plan);
}

}  // namespace cloth
