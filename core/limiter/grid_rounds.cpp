#include "limiter/grid_rounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limiter/tension_steps.h"

namespace cloth {
namespace {

constexpr int rows_in_lanes = tension::lanes_of_rows;
int first_of_block(int row) {
  return row / rows_in_lanes * rows_in_lanes;
}

constexpr int lines_in_lanes = 128;  ///< columns or diagonals at most: what the cache holds
constexpr int most_terms = 16;       ///< springs of a particle, in twelve directions

}  // namespace

GridRounds::GridRounds(const GridPlan& plan) : plan_(plan) {
  const std::size_t size = plan.size(), line = static_cast<std::size_t>(plan.stride) * rows_in_lanes;
  for (AlignedDoubles* field : {&x_, &y_, &z_, &weight_}) field->assign(size, 0.0);
  for (tension::AlignedFloats* field : {&light_, &sx_, &sy_, &sz_}) field->assign(size, 0.0f);
  zero_.assign(line, 0.0f);
  shortest_ = std::numeric_limits<double>::infinity();
  const std::size_t blocks = static_cast<std::size_t>((plan.rows + rows_in_lanes - 1) / rows_in_lanes);
  for (const GridFamily& member : plan.families) {
    Family& family = families_.emplace_back();
    family.plan = member;
    family.offset = plan.offset(member);
    shortest_ = std::min(shortest_, member.rest_length);
    family.tension.assign(size, 0.0);
    for (tension::AlignedFloats* field :
         {&family.ax, &family.ay, &family.az, &family.over, &family.change, &family.residual, &family.solved,
          &family.direction, &family.product})
      field->assign(size, 0.0f);
    for (tension::AlignedFloats* field : {&family.link, &family.pivot})
      field->assign(family.is_row() ? blocks * line : size, 0.0f);
    family.lengths.resize(static_cast<std::size_t>(member.rows));
    family.residuals.resize(static_cast<std::size_t>(member.rows));
  }
  for (AlignedDoubles* field : {&lanes_x_, &lanes_y_, &lanes_z_, &lanes_}) field->assign(line, 0.0);
  for (tension::AlignedFloats* field : {&floats_x_, &floats_y_, &floats_z_, &floats_})
    field->assign(line, 0.0f);
  lanes_weight_.assign(blocks * line, 0.0);
  floats_weight_.assign(blocks * line, 0.0f);
}

/// They hardly ever change.
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
      light_[i] = static_cast<float>(weight_[i]);
    }
  for (Family& family : families_) {
    family.pins.assign(static_cast<std::size_t>(family.plan.rows), 0);
    for (int row = 0; row < family.plan.rows; ++row)
      for (int column = family.plan.begin; column < family.plan.end; ++column) {
        const std::ptrdiff_t i = plan_.index(row, column);
        const bool pins = !(
            weight_[static_cast<std::size_t>(i)] + weight_[static_cast<std::size_t>(i + family.offset)] > 0);
        family.pins[static_cast<std::size_t>(row)] |= static_cast<std::uint8_t>(pins);
      }
  }
  for (int first = 0; first < plan_.rows; first += rows_in_lanes) {
    const int count = std::min(rows_in_lanes, plan_.rows - first);
    const std::ptrdiff_t i = plan_.index(first, 0), block = static_cast<std::ptrdiff_t>(first) * plan_.stride;
    tension::into_lanes(weight_.data() + i, plan_.stride, count, plan_.columns, lanes_weight_.data() + block);
    tension::into_lanes(light_.data() + i, plan_.stride, count, plan_.columns, floats_weight_.data() + block);
  }
}

void GridRounds::begin(const TensionTask& task, const std::vector<double>& inverse_mass,
                       const std::vector<double>& tension, const Vec3Field& position) {
  task_ = task;
  take_weights(inverse_mass);
  const double largest = *std::max_element(inverse_mass.begin(), inverse_mass.end());
  unit_ = task.time_step * task.time_step * (largest > 0 ? largest : 1);
  const double* from[] = {position.x(), position.y(), position.z()};
  AlignedDoubles* to[] = {&x_, &y_, &z_};
  for (int row = 0; row < plan_.rows; ++row)
    for (int k = 0; k < 3; ++k)
      std::copy_n(from[k] + static_cast<std::ptrdiff_t>(row) * plan_.columns, plan_.columns,
                  to[k]->data() + plan_.index(row, 0));
  for (Family& family : families_)
    for (int row = 0; row < family.plan.rows; ++row) {
      const int width = family.plan.width();
      const double* there =
          tension.data() + family.plan.first_spring + static_cast<std::ptrdiff_t>(row) * width;
      double* here = family.tension.data() + plan_.index(row, family.plan.begin);
      for (int c = 0; c < width; ++c) here[c] = unit_ * there[c];
    }
  moved_ = {0, plan_.rows};
}

void GridRounds::end(std::vector<double>& tension, Vec3Field& position) const {
  const AlignedDoubles* from[] = {&x_, &y_, &z_};
  double* to[] = {position.x(), position.y(), position.z()};
  for (int row = 0; row < plan_.rows; ++row)
    for (int k = 0; k < 3; ++k)
      std::copy_n(from[k]->data() + plan_.index(row, 0), plan_.columns,
                  to[k] + static_cast<std::ptrdiff_t>(row) * plan_.columns);
  for (const Family& family : families_)
    for (int row = 0; row < family.plan.rows; ++row) {
      const double* here = family.tension.data() + plan_.index(row, family.plan.begin);
      const int width = family.plan.width();
      double* there = tension.data() + family.plan.first_spring + static_cast<std::ptrdiff_t>(row) * width;
      for (int c = 0; c < width; ++c) there[c] = here[c] / unit_;
    }
}

tension::Nodes GridRounds::nodes() {
  return {x_.data(), y_.data(), z_.data(), weight_.data()};
}

tension::SpringRule GridRounds::rule_of(const Family& family) const {
  return {family.plan.limit, task_.softness, least_ridge};
}

/// Rows of a family's springs within an interval.
GridRounds::Interval GridRounds::rows_of(const Family& family, Interval rows) const {
  return {std::max(rows.begin, 0), std::min(rows.end, family.plan.rows)};
}

void GridRounds::equate(Family& family, int row) {
  const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
  tension::evaluate_row(nodes(), i, family.offset, family.tension.data() + i, family.plan.width(),
                        rule_of(family),
                        {family.ax.data() + i, family.ay.data() + i, family.az.data() + i,
                         family.over.data() + i, family.residual.data() + i});
}

void GridRounds::measure(Family& family, int row) {
  const auto r = static_cast<std::size_t>(row);
  const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
  const double* tension = family.tension.data() + i;
  if (task_.softness > 0) {
    equate(family, row);
    family.residuals[r] = tension::residual_row(tension, family.over.data() + i, family.plan.width());
  } else {
    family.lengths[r] =
        tension::measure_row(nodes(), i, family.offset, tension, family.plan.width(), family.pins[r] != 0);
  }
}

bool GridRounds::is_active(const Family& family, int row) const {
  const auto r = static_cast<std::size_t>(row);
  if (task_.softness > 0) return family.residuals[r].active;
  const tension::RowLengths& found = family.lengths[r];
  return found.longest > family.plan.limit * family.plan.limit ||
         found.shortest < std::numeric_limits<double>::infinity();
}

TensionResidual GridRounds::evaluate() {
  TensionResidual found;
  active_ = {plan_.rows, 0};
  for (Family& family : families_) {
    const Interval changed = rows_of(family, {moved_.begin - family.plan.down, moved_.end});
    for (int row = changed.begin; row < changed.end; ++row) measure(family, row);
    double longest = 0, shortest = std::numeric_limits<double>::infinity();
    tension::RowResidual soft;
    for (int row = 0; row < family.plan.rows; ++row) {
      const auto r = static_cast<std::size_t>(row);
      if (!is_active(family, row)) continue;
      active_.begin = std::min(active_.begin, row);
      active_.end = std::max(active_.end, row + 1);
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
  if (active_.begin >= active_.end) return;
  for (std::size_t k = 0; k < families_.size(); ++k) {
    Family& family = families_[backwards ? families_.size() - 1 - k : k];
    if (family.is_row())
      sweep_rows(family);
    else
      sweep_columns(family);
  }
  moved_ = {std::min(moved_.begin, active_.begin - 1), std::max(moved_.end, active_.end + 1 + plan_.reach)};
}

void GridRounds::sweep_rows(Family& family) {
  const Interval rows = rows_of(family, {active_.begin - 1, active_.end + 1});
  const int columns = plan_.columns, across = family.plan.across;
  for (int first = first_of_block(rows.begin); first < rows.end; first += rows_in_lanes) {
    const int count = std::min(rows_in_lanes, plan_.rows - first);
    const std::ptrdiff_t i = plan_.index(first, 0);
    const auto load = [&](const AlignedDoubles& from, AlignedDoubles& to) {
      tension::into_lanes(from.data() + i, plan_.stride, count, columns, to.data());
    };
    load(x_, lanes_x_), load(y_, lanes_y_), load(z_, lanes_z_);
    load(family.tension, lanes_);
    for (int start = 0; start < across; ++start) {
      const tension::LineBlock block{
          .nodes = {lanes_x_.data(), lanes_y_.data(), lanes_z_.data(),
                    lanes_weight_.data() + static_cast<std::ptrdiff_t>(first) * plan_.stride},
          .tension = lanes_.data(),
          .first = start * rows_in_lanes,
          .step = across * rows_in_lanes,
          .count = (columns - 1 - start) / across,
          .lanes = rows_in_lanes,
          .begin = 0,
          .end = rows_in_lanes,
          .shift = 0};
      tension::sweep_block(block, rule_of(family), scratch_);
    }
    const auto keep = [&](const AlignedDoubles& from, AlignedDoubles& to) {
      tension::out_of_lanes(from.data(), plan_.stride, count, columns, to.data() + i);
    };
    keep(lanes_x_, x_), keep(lanes_y_, y_), keep(lanes_z_, z_), keep(lanes_, family.tension);
  }
}

void GridRounds::sweep_columns(Family& family) {
  const Interval rows = rows_of(family, {active_.begin - 1, active_.end + 1});
  for (int start = rows.begin; start < std::min(rows.begin + family.plan.down, rows.end); ++start) {
    const int count = (rows.end - start - 1) / family.plan.down + 1;
    // A line is told by the column in which it would stand in the row `start`.
    const int across = family.plan.across, drift = (count - 1) * across;
    const int low = family.plan.begin - std::max(0, drift), high = family.plan.end - std::min(0, drift);

    for (int column = low; column < high; column += lines_in_lanes) {
      const tension::LineBlock block{.nodes = nodes(),
                                     .tension = family.tension.data(),
                                     .first = plan_.index(start, column),
                                     .step = family.offset,
                                     .count = count,
                                     .lanes = std::min(lines_in_lanes, high - column),
                                     .begin = family.plan.begin - column,
                                     .end = family.plan.end - column,
                                     .shift = across};
      tension::sweep_block(block, rule_of(family), scratch_);
    }
  }
}

void GridRounds::find_equations() {
  for (Family& family : families_) {
    const Interval rows = rows_of(family, active_);
    for (int row = rows.begin; row < rows.end; ++row) {
      equate(family, row);
      std::fill_n(family.change.data() + plan_.index(row, family.plan.begin), family.plan.width(), 0.0f);
    }
  }
}

void GridRounds::factorise() {
  const double ridge = ridge_of(task_);
  for (Family& family : families_) {
    if (family.is_row()) {
      factorise_lanes(family);
      continue;
    }
    const Interval rows = rows_of(family, active_);
    const int width = family.plan.width();
    for (int row = rows.begin; row < rows.end; ++row) {
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      const auto at = [&](std::ptrdiff_t k) {
        return tension::FactorRow{family.ax.data() + k,
                                  family.ay.data() + k,
                                  family.az.data() + k,
                                  light_.data() + k,
                                  light_.data() + k + family.offset,
                                  family.link.data() + k,
                                  family.pivot.data() + k};
      };
      const float* zero = zero_.data();
      const bool first = row - family.plan.down < rows.begin;
      const tension::FactorRow none{zero, zero, zero, zero, zero, nullptr, zero_.data()};
      tension::factorise_row(at(i), first ? none : at(i - family.offset), ridge, width);
    }
  }
}

/// Springs of a row in turn, rows side by side.
void GridRounds::factorise_lanes(Family& family) {
  const Interval rows = rows_of(family, active_);
  const int columns = plan_.columns, across = family.plan.across;
  for (int first = first_of_block(rows.begin); first < rows.end; first += rows_in_lanes) {
    const int count = std::min(rows_in_lanes, plan_.rows - first);
    const std::ptrdiff_t i = plan_.index(first, 0);
    const auto load = [&](const tension::AlignedFloats& from, tension::AlignedFloats& to) {
      tension::into_lanes(from.data() + i, plan_.stride, count, columns, to.data());
    };
    load(family.ax, floats_x_), load(family.ay, floats_y_), load(family.az, floats_z_);
    const std::ptrdiff_t block = static_cast<std::ptrdiff_t>(first) * plan_.stride;
    for (int c = 0; c < family.plan.end; ++c) {
      const auto at = [&](int column) {
        const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(column) * rows_in_lanes;
        return tension::FactorRow{floats_x_.data() + k,
                                  floats_y_.data() + k,
                                  floats_z_.data() + k,
                                  floats_weight_.data() + block + k,
                                  floats_weight_.data() + block + k + across * rows_in_lanes,
                                  family.link.data() + block + k,
                                  family.pivot.data() + block + k};
      };
      const float* zero = zero_.data();
      const tension::FactorRow none{zero, zero, zero, zero, zero, nullptr, zero_.data()};
      tension::factorise_row(at(c), c < across ? none : at(c - across), ridge_of(task_), rows_in_lanes);
    }
  }
}

void GridRounds::precondition_lanes(Family& family, int first) {
  const std::ptrdiff_t i = plan_.index(first, 0), block = static_cast<std::ptrdiff_t>(first) * plan_.stride;
  tension::solve_lanes({family.link.data() + block, family.pivot.data() + block, floats_.data()},
                       family.residual.data() + i, plan_.stride, std::min(rows_in_lanes, plan_.rows - first),
                       family.plan.end, family.plan.across, family.solved.data() + i);
}

/// Of what is preconditioned, a row after those above it.
void GridRounds::eliminate(Family& family, int row) {
  const Interval rows = rows_of(family, active_);
  if (row < rows.begin || row >= rows.end) return;
  if (family.is_row()) {
    if ((row + 1) % rows_in_lanes == 0 || row + 1 == rows.end)
      precondition_lanes(family, first_of_block(row));
    return;
  }
  const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
  const bool first = row - family.plan.down < rows.begin;
  tension::eliminate_row(family.residual.data() + i, family.link.data() + i, family.pivot.data() + i,
                         first ? zero_.data() : family.solved.data() + i - family.offset,
                         family.solved.data() + i, family.plan.width());
}

/// Back substitution from the last row to the first. Returns residual . solved.
double GridRounds::precondition() {
  double product = 0;
  for (int row = active_.end; row-- > active_.begin;)
    for (Family& family : families_) {
      const Interval rows = rows_of(family, active_);
      if (row >= rows.end) continue;
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      if (!family.is_row() && row + family.plan.down < rows.end) {
        const std::ptrdiff_t next = i + family.offset;
        tension::substitute_row(family.pivot.data() + i, family.link.data() + next,
                                family.solved.data() + next, family.solved.data() + i, family.plan.width());
      }
      product += tension::dot_row(family.residual.data() + i, family.solved.data() + i, family.plan.width());
    }
  return product;
}

/// What pulls on a row of particles: springs that begin there and springs that end there.
int GridRounds::pulls_on(int row, tension::AlignedFloats Family::*value, tension::PullTerm* terms) const {
  int count = 0;
  const std::ptrdiff_t i = plan_.index(row, 0);
  for (const Family& family : families_) {
    const Interval rows = rows_of(family, active_);
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

/// s of a row of particles
void GridRounds::pull(int row, tension::AlignedFloats Family::*value) {
  tension::PullTerm terms[most_terms];
  const int count = pulls_on(row, value, terms);
  const std::ptrdiff_t i = plan_.index(row, 0);
  if (count > 0)
    tension::pull_row(terms, count, light_.data() + i, sx_.data() + i, sy_.data() + i, sz_.data() + i,
                      plan_.columns);
}

/// product <- (J W J^T + ridge diagonal) value, row by row as the particles' rows become known. Returns
/// value . product.
double GridRounds::apply(tension::AlignedFloats Family::*value, double ridge) {
  double dot = 0;
  const int end = std::min(plan_.rows, active_.end + plan_.reach);
  for (int row = active_.begin; row < end; ++row) {
    pull(row, value);
    for (Family& family : families_) {
      const Interval rows = rows_of(family, active_);
      const int begins = row - family.plan.down;
      if (begins < rows.begin || begins >= rows.end) continue;
      const std::ptrdiff_t i = plan_.index(begins, family.plan.begin);
      dot += tension::answer_row(
          {family.ax.data() + i, family.ay.data() + i, family.az.data() + i, (family.*value).data() + i,
           light_.data() + i, sx_.data() + i, sy_.data() + i, sz_.data() + i, family.product.data() + i},
          family.offset, ridge, family.plan.width());
    }
  }
  return dot;
}

/// Returns the largest residual that is left.
double GridRounds::advance(double length) {
  float largest = 0;
  for (int row = active_.begin; row < active_.end; ++row)
    for (Family& family : families_) {
      if (row >= family.plan.rows) continue;
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      largest =
          std::max(largest, tension::advance_row(static_cast<float>(length), family.direction.data() + i,
                                                 family.product.data() + i, family.change.data() + i,
                                                 family.residual.data() + i, family.plan.width()));
      eliminate(family, row);
    }
  return largest;
}

int GridRounds::conjugate_gradients() {
  const double ridge = ridge_of(task_);
  float largest = 0;
  for (int row = active_.begin; row < active_.end; ++row)
    for (Family& family : families_) {
      if (row >= family.plan.rows) continue;
      const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
      largest = std::max(largest, tension::largest_row(family.residual.data() + i, family.plan.width()));
      eliminate(family, row);
    }
  const double enough =
      std::max(enough_of_residual * largest, enough_of_tolerance * task_.tolerance * shortest_);
  double product = precondition(), share = 0;
  int iterations = 0;
  while (iterations < most_gradients && product > 0) {
    for (int row = active_.begin; row < active_.end; ++row)
      for (Family& family : families_) {
        if (row >= family.plan.rows) continue;
        const std::ptrdiff_t i = plan_.index(row, family.plan.begin);
        if (iterations == 0)
          std::copy_n(family.solved.data() + i, family.plan.width(), family.direction.data() + i);
        else
          tension::turn_row(family.solved.data() + i, static_cast<float>(share), family.direction.data() + i,
                            family.plan.width());
      }
    const double length = product / apply(&Family::direction, ridge);
    ++iterations;
    if (advance(length) <= enough) break;
    const double next = precondition();
    share = next / product;
    product = next;
  }
  return iterations;
}

/// Tensions stay at least 0. Where that clips one, the step is only as long as it brings C nearer to 0.
void GridRounds::take_step() {
  const auto each_row = [&](auto visit) {
    for (Family& family : families_) {
      const Interval rows = rows_of(family, active_);
      for (int row = rows.begin; row < rows.end; ++row) visit(family, plan_.index(row, family.plan.begin));
    }
  };
  bool clipped = false;
  double gain = 0, length = 1;
  each_row([&](Family& family, std::ptrdiff_t i) {
    const tension::ClippedRow found = tension::clip_row(family.tension.data() + i, family.over.data() + i,
                                                        family.change.data() + i, family.plan.width());
    gain += found.gain;
    clipped = clipped || found.clipped;
  });
  if (clipped) length = gain > 0 ? std::min(1.0, gain / apply(&Family::change, task_.softness)) : 0;
  if (!(length > 0)) {
    length = 1;
    each_row([&](Family& family, std::ptrdiff_t i) {
      tension::steepest_row(static_cast<float>(steepest_share), family.over.data() + i, light_.data() + i,
                            light_.data() + i + family.offset, family.tension.data() + i,
                            family.change.data() + i, family.plan.width());
    });
  }
  each_row([&](Family& family, std::ptrdiff_t i) {
    tension::raise_row(length, family.change.data() + i, family.tension.data() + i, family.plan.width());
  });
  const int end = std::min(plan_.rows, active_.end + plan_.reach);
  for (int row = active_.begin; row < end; ++row) {
    tension::PullTerm terms[most_terms];
    const int count = pulls_on(row, &Family::change, terms);
    const std::ptrdiff_t i = plan_.index(row, 0);
    tension::move_row(terms, count, length, weight_.data() + i, x_.data() + i, y_.data() + i, z_.data() + i,
                      plan_.columns);
  }
  moved_ = {std::min(moved_.begin, active_.begin), std::max(moved_.end, end)};
}

int GridRounds::solve_together() {
  if (active_.begin >= active_.end) return 0;
  find_equations();
  factorise();
  const int iterations = conjugate_gradients();
  take_step();
  return iterations;
}

std::unique_ptr<TensionRounds> make_tension_rounds(const std::vector<TensionSpring>& springs,
                                                   const ClothSystem& system) {
  if (const auto grid = plan_grid(springs, system)) return std::make_unique<GridRounds>(*grid);
  return make_line_rounds(springs, system);
}

}  // namespace cloth
