#include "sparse/block_cholesky.h"

#include <algorithm>
#include <cassert>

#include "geometry/at.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

// Legend: m a front's height, w its width, r = m - w the size of its update, all in numbers, not blocks.

/// Of a row or column, given by its place in the order, within a front; in blocks.
int within(const Front& front, int place) {
  if (place < front.first + front.width) return place - front.first;
  const auto found = std::lower_bound(front.rows.begin(), front.rows.end(), place);
  return front.width + static_cast<int>(found - front.rows.begin());
}

}  // namespace

void BlockCholesky::analyse(const std::vector<Coupling>& couplings, const std::vector<int>& order) {
  tree_ = cloth::analyse(couplings, order);
  panels_.assign(tree_.fronts.size(), {});
  place_entries(couplings);
  plan_memory();
}

void BlockCholesky::place_entries(const std::vector<Coupling>& couplings) {
  std::vector<std::size_t> front_of(tree_.place.size());
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f)
    for (int c = 0; c < tree_.fronts[f].width; ++c) front_of[at(tree_.fronts[f].first + c)] = f;

  struct Placed {
    std::size_t front;
    Entry entry;
  };
  std::vector<Placed> placed;
  placed.reserve(couplings.size());
  for (std::size_t k = 0; k < couplings.size(); ++k) {
    const int a = tree_.place[at(couplings[k].first)], b = tree_.place[at(couplings[k].second)];
    const std::size_t f = front_of[at(std::min(a, b))];
    const Front& front = tree_.fronts[f];
    const std::size_t height = block_ * at(front.height());
    const std::size_t row = block_ * at(within(front, std::max(a, b)));
    const std::size_t column = block_ * at(within(front, std::min(a, b)));
    placed.push_back({f, {k * block_ * block_, row + column * height, a < b}});
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& p, const Placed& q) { return p.front < q.front; });
  entries_.clear();
  for (const Placed& p : placed) {
    if (panels_[p.front].end_entry == 0) panels_[p.front].first_entry = entries_.size();
    entries_.push_back(p.entry);
    panels_[p.front].end_entry = entries_.size();
  }
}

void BlockCholesky::plan_memory() {
  std::size_t kept = 0, stack = 0, highest = 0;
  tallest_ = 0;
  operations_ = 0;
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    Panel& panel = panels_[f];
    const std::size_t m = block_ * at(front.height()), w = block_ * at(front.width), r = m - w;
    panel.begin = kept;
    kept += m * w;
    tallest_ = std::max(tallest_, r);
    for (std::size_t j = 0; j < w; ++j) operations_ += 0.5 * static_cast<double>((m - j) * (m - j));
    highest = std::max(highest, stack + r * r);
    for (const int child : panel.children) {
      const std::size_t size = block_ * tree_.fronts[at(child)].rows.size();
      stack -= size * size;
    }
    stack += r * r;
    if (front.parent < 0) continue;
    panels_[at(front.parent)].children.push_back(static_cast<int>(f));
    for (const int row : front.rows) panel.in_parent.push_back(within(tree_.fronts[at(front.parent)], row));
  }
  factors_.resize(kept);
  updates_.resize(highest);
  unknown_at_.resize(tree_.place.size());
  for (std::size_t i = 0; i < tree_.place.size(); ++i) unknown_at_[at(tree_.place[i])] = i;
}

/// The front's columns of the matrix. `columns` is zero before.
void BlockCholesky::gather(std::size_t f, std::span<const double> diagonal,
                           std::span<const double> coupling_blocks, double* columns) const {
  const Front& front = tree_.fronts[f];
  const Panel& panel = panels_[f];
  const std::size_t b = block_, m = b * at(front.height());
  const auto add = [&](const double* from, double* to) {
    for (std::size_t k = 0; k < b; ++k)
      for (std::size_t i = 0; i < b; ++i) to[i + k * m] += from[i + k * b];
  };
  for (int c = 0; c < front.width; ++c)
    add(diagonal.data() + unknown_at_[at(front.first + c)] * b * b, columns + b * at(c) * (m + 1));
  const auto add_transposed = [&](const double* from, double* to) {
    for (std::size_t k = 0; k < b; ++k)
      for (std::size_t i = 0; i < b; ++i) to[i + k * m] += from[k + i * b];
  };
  for (std::size_t e = panel.first_entry; e < panel.end_entry; ++e) {
    const Entry& entry = entries_[e];
    const double* from = coupling_blocks.data() + entry.source;
    if (entry.transposed)
      add_transposed(from, columns + entry.target);
    else
      add(from, columns + entry.target);
  }
}

/// A child's update, an array of its own, to the columns of its parent's front and to its parent's update.
void BlockCholesky::add_update(std::size_t child, const double* from, double* columns, double* update) const {
  const std::vector<int>& rows = panels_[child].in_parent;
  const Front& parent = tree_.fronts[at(tree_.fronts[child].parent)];
  const std::size_t b = block_, m = b * at(parent.height()), w = b * at(parent.width), r = m - w;
  const std::size_t size = b * rows.size();
  for (std::size_t q = 0; q < rows.size(); ++q) {
    const std::size_t column = b * at(rows[q]);
    const bool own = column < w;
    double* to = own ? columns + column * m : update + (column - w) * r;
    const std::size_t stride = own ? m : r, above = own ? 0 : w;
    for (std::size_t p = q; p < rows.size(); ++p) {
      const double* block = from + b * (p + q * size);
      double* target = to + (b * at(rows[p]) - above);
      for (std::size_t k = 0; k < b; ++k)
        for (std::size_t i = 0; i < b; ++i) target[i + k * stride] += block[i + k * size];
    }
  }
}

bool BlockCholesky::factorise(std::span<const double> diagonal, std::span<const double> coupling_blocks) {
  const DenseKernels& dense = active_kernels<DenseKernels>();
  std::fill(factors_.begin(), factors_.end(), 0.0);
  std::size_t top = 0;  // of the stack of updates
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    const std::size_t m = block_ * at(front.height()), w = block_ * at(front.width), r = m - w;
    double* columns = factors_.data() + panels_[f].begin;
    double* update = updates_.data() + top;
    std::fill(update, update + r * r, 0.0);
    gather(f, diagonal, coupling_blocks, columns);

    std::size_t bottom = top;  // of the children's updates, the last of which lies highest
    for (auto child = panels_[f].children.rbegin(); child != panels_[f].children.rend(); ++child) {
      const std::size_t size = block_ * panels_[at(*child)].in_parent.size();
      bottom -= size * size;
      add_update(at(*child), updates_.data() + bottom, columns, update);
    }
    if (!dense.factorise_columns({columns, m}, static_cast<int>(m), static_cast<int>(w))) return false;
    dense.subtract_square({update, r}, {columns + w, m}, static_cast<int>(r), static_cast<int>(w));
    if (bottom != top) std::copy(update, update + r * r, updates_.data() + bottom);
    top = bottom + r * r;
  }
  return true;
}

namespace {

void add_to(double& to, double from) {
  to += from;
}
void add_to(Quad& to, const Quad& from) {
  for (int n = 0; n < 4; ++n) to.of[n] += from.of[n];
}

auto eliminate_of(const DenseKernels& dense, double*) {
  return dense.eliminate;
}
auto eliminate_of(const DenseKernels& dense, Quad*) {
  return dense.eliminate_quads;
}
auto substitute_of(const DenseKernels& dense, double*) {
  return dense.substitute;
}
auto substitute_of(const DenseKernels& dense, Quad*) {
  return dense.substitute_quads;
}

}  // namespace

/// x <- A^-1 x, its numbers in the order of elimination.
template <class Number>
void BlockCholesky::solve_ordered(Number* x, std::vector<Number>& below) {
  const DenseKernels& dense = active_kernels<DenseKernels>();
  const auto eliminate = eliminate_of(dense, x);
  const auto substitute = substitute_of(dense, x);
  below.resize(tallest_);
  const auto panel = [&](std::size_t f) {
    const std::size_t m = block_ * at(tree_.fronts[f].height());
    return DenseBlock{factors_.data() + panels_[f].begin, m};
  };
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const Front& front = tree_.fronts[f];
    const std::size_t m = block_ * at(front.height()), w = block_ * at(front.width);
    std::fill(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(m - w), Number{});
    eliminate(panel(f), static_cast<int>(m), static_cast<int>(w), x + block_ * at(front.first), below.data());
    const Number* from = below.data();
    for (const int row : front.rows)
      for (std::size_t k = 0; k < block_; ++k) add_to(x[block_ * at(row) + k], *from++);
  }
  for (std::size_t f = tree_.fronts.size(); f-- > 0;) {
    const Front& front = tree_.fronts[f];
    const std::size_t m = block_ * at(front.height()), w = block_ * at(front.width);
    Number* to = below.data();
    for (const int row : front.rows)
      for (std::size_t k = 0; k < block_; ++k) *to++ = x[block_ * at(row) + k];
    substitute(panel(f), static_cast<int>(m), static_cast<int>(w), x + block_ * at(front.first),
               below.data());
  }
}

void BlockCholesky::solve(std::span<double> values, int columns) {
  const std::size_t size = block_ * tree_.place.size();
  assert(values.size() == size * at(columns) && columns <= 4);
  const auto for_each = [&](auto visit) {  // of a number's place in `values` and in the order of elimination
    for (std::size_t i = 0; i < tree_.place.size(); ++i)
      for (std::size_t k = 0; k < block_; ++k) visit(block_ * i + k, block_ * at(tree_.place[i]) + k);
  };
  if (columns == 1) {
    ordered_.resize(size);
    for_each([&](std::size_t k, std::size_t place) { ordered_[place] = values[k]; });
    solve_ordered(ordered_.data(), below_);
    for_each([&](std::size_t k, std::size_t place) { values[k] = ordered_[place]; });
    return;
  }
  ordered_quads_.assign(size, Quad{});
  for (int n = 0; n < columns; ++n)
    for_each(
        [&](std::size_t k, std::size_t place) { ordered_quads_[place].of[n] = values[k + at(n) * size]; });
  solve_ordered(ordered_quads_.data(), below_quads_);
  for (int n = 0; n < columns; ++n)
    for_each(
        [&](std::size_t k, std::size_t place) { values[k + at(n) * size] = ordered_quads_[place].of[n]; });
}

}  // namespace cloth
