#include "sparse/elimination_tree.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cloth {
namespace {

using Columns = std::vector<std::vector<int>>;  // the rows below the diagonal of each column

std::vector<int> inverse_of(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (std::size_t k = 0; k < permutation.size(); ++k)
    inverse[static_cast<std::size_t>(permutation[k])] = static_cast<int>(k);
  return inverse;
}

/// The entries below the diagonal, sorted, each once.
Columns lower_columns(const std::vector<Coupling>& couplings, const std::vector<int>& place) {
  Columns columns(place.size());
  for (const auto& [i, j] : couplings) {
    const int a = place[static_cast<std::size_t>(i)], b = place[static_cast<std::size_t>(j)];
    if (a != b) columns[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
  }
  for (std::vector<int>& rows : columns) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  return columns;
}

/// The parent of each column, -1 at a root, before fill-in: from every entry of a row to the root of the tree
/// so far, with path compression (Liu 1990).
std::vector<int> find_parents(const Columns& columns) {
  std::vector<int> parent(columns.size(), -1), shortcut(columns.size(), -1);
  Columns of_row(columns.size());
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (const int row : columns[j]) of_row[static_cast<std::size_t>(row)].push_back(static_cast<int>(j));
  for (int row = 0; row < static_cast<int>(columns.size()); ++row) {
    for (int j : of_row[static_cast<std::size_t>(row)]) {
      while (j >= 0 && j < row) {
        const int next = std::exchange(shortcut[static_cast<std::size_t>(j)], row);
        if (next < 0) parent[static_cast<std::size_t>(j)] = row;
        j = next;
      }
    }
  }
  return parent;
}

/// Adds the fill-in: the rest of each column to its parent.
void fill_in(Columns& columns) {
  std::vector<int> merged;
  for (const std::vector<int>& rows : columns) {
    if (rows.empty()) continue;
    std::vector<int>& parent = columns[static_cast<std::size_t>(rows.front())];
    merged.clear();
    std::set_union(parent.begin(), parent.end(), rows.begin() + 1, rows.end(), std::back_inserter(merged));
    parent = merged;
  }
}

/// The columns so that every subtree is one run that ends with its root.
std::vector<int> post_order(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> first_child(parent.size(), -1), sibling(parent.size(), -1), roots, order, open;
  for (int j = size - 1; j >= 0; --j) {
    const int p = parent[static_cast<std::size_t>(j)];
    if (p < 0) {
      roots.push_back(j);
      continue;
    }
    sibling[static_cast<std::size_t>(j)] = first_child[static_cast<std::size_t>(p)];
    first_child[static_cast<std::size_t>(p)] = j;
  }
  order.reserve(parent.size());
  open = roots;  // descending, so that the smallest comes off first
  while (!open.empty()) {
    const int j = open.back();
    int& child = first_child[static_cast<std::size_t>(j)];
    if (child >= 0) {
      open.push_back(child);
      child = sibling[static_cast<std::size_t>(child)];
      continue;
    }
    order.push_back(j);
    open.pop_back();
  }
  return order;
}

/// Whether a front with the columns of `child` and `parent`, which follow one another, is worth its zeros.
bool worth_merging(const Front& child, const Front& parent, long zeros) {
  constexpr int always_below = 4;  // columns
  constexpr double max_zeros = 0.12;
  const long width = child.width + parent.width, height = child.width + parent.height();
  const auto entries = static_cast<double>(width * height - width * (width - 1) / 2);
  return (child.width <= always_below && width <= 2 * always_below) ||
         static_cast<double>(zeros) <= max_zeros * entries;
}

std::vector<Front> make_fronts(const Columns& columns) {
  std::vector<Front> fronts;
  std::vector<long> zeros;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    // A column begins a front of its own, which then swallows those right before it that it is the parent of.
    Front front{.first = static_cast<int>(j), .width = 1, .parent = -1, .rows = columns[j]};
    long of_front = 0;
    while (!fronts.empty()) {
      const Front& child = fronts.back();
      if (child.rows.empty() || child.rows.front() >= front.first + front.width) break;
      const long added =
          static_cast<long>(child.width) * (front.height() - static_cast<long>(child.rows.size()));
      const long sum = of_front + zeros.back() + added;
      if (added > 0 && !worth_merging(child, front, sum)) break;
      front.first = child.first;
      front.width += child.width;
      of_front = sum;
      fronts.pop_back();
      zeros.pop_back();
    }
    fronts.push_back(std::move(front));
    zeros.push_back(of_front);
  }
  return fronts;
}

void join(std::vector<Front>& fronts, std::size_t columns) {
  std::vector<int> front_of(columns);
  for (std::size_t f = 0; f < fronts.size(); ++f)
    for (int c = 0; c < fronts[f].width; ++c)
      front_of[static_cast<std::size_t>(fronts[f].first + c)] = static_cast<int>(f);
  for (Front& front : fronts)
    if (!front.rows.empty()) front.parent = front_of[static_cast<std::size_t>(front.rows.front())];
}

}  // namespace

EliminationTree analyse(const std::vector<Coupling>& couplings, const std::vector<int>& order) {
  EliminationTree tree;
  tree.place = inverse_of(order);
  Columns columns = lower_columns(couplings, tree.place);
  const std::vector<int> moved = inverse_of(post_order(find_parents(columns)));
  for (int& place : tree.place) place = moved[static_cast<std::size_t>(place)];
  columns = lower_columns(couplings, tree.place);
  fill_in(columns);
  tree.fronts = make_fronts(columns);
  join(tree.fronts, columns.size());
  return tree;
}

}  // namespace cloth
