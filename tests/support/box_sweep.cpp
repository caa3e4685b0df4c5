#include "support/box_sweep.h"

#include <algorithm>
#include <limits>

namespace cloth::test {
namespace {

/// Along which the boxes lie furthest apart, in terms of their own widths.
std::size_t best_axis(const std::vector<Extent>& boxes) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    double least = std::numeric_limits<double>::infinity(), furthest = -least, widths = 0;
    for (const Extent& box : boxes) {
      least = std::min(least, box.least[k]), furthest = std::max(furthest, box.most[k]);
      widths += box.most[k] - box.least[k];
    }
    const double spread = (furthest - least) / (widths + std::numeric_limits<double>::min());
    if (spread > most) most = spread, best = k;
  }
  return best;
}

/// Indices of the boxes that are not apart from `hull`, by where they begin.
std::vector<std::size_t> by_lower_end(const std::vector<Extent>& boxes, std::size_t axis,
                                      const Extent& hull) {
  std::vector<std::pair<double, std::size_t>> begins;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!apart(boxes[i], hull)) begins.emplace_back(boxes[i].least[axis], i);
  std::sort(begins.begin(), begins.end());
  std::vector<std::size_t> order;
  for (const auto& begin : begins) order.push_back(begin.second);
  return order;
}

/// A pair is found from the box that begins first, or of two that begin together from that of `a`: `found`
/// gets the box that begins first and those of the other list that begin before it ends.
template <class Found>
void sweep(const std::vector<Extent>& first, const std::vector<Extent>& second, std::size_t axis,
           bool ties_count, const Found& found) {
  const std::vector<std::size_t> outer = by_lower_end(first, axis, hull_of(second)),
                                 inner = by_lower_end(second, axis, hull_of(first));
  std::size_t begin = 0;
  for (const std::size_t i : outer) {
    const double from = first[i].least[axis], to = first[i].most[axis];
    const auto is_before = [&](std::size_t j) {
      return ties_count ? second[j].least[axis] < from : second[j].least[axis] <= from;
    };
    while (begin < inner.size() && is_before(inner[begin])) ++begin;
    for (std::size_t n = begin; n < inner.size() && second[inner[n]].least[axis] <= to; ++n)
      if (!apart(first[i], second[inner[n]])) found(i, inner[n]);
  }
}

}  // namespace

Extent hull_of(const std::vector<Extent>& boxes) {
  constexpr double none = std::numeric_limits<double>::infinity();
  Extent hull{{none, none, none}, {-none, -none, -none}};
  for (const Extent& box : boxes)
    for (std::size_t k = 0; k < 3; ++k)
      hull.least[k] = std::min(hull.least[k], box.least[k]),
      hull.most[k] = std::max(hull.most[k], box.most[k]);
  return hull;
}

std::vector<IndexPair> overlaps_by_sweep(const std::vector<Extent>& a, const std::vector<Extent>& b) {
  const std::size_t axis = best_axis(a.size() > b.size() ? a : b);
  std::vector<IndexPair> pairs;
  sweep(a, b, axis, true, [&](std::size_t i, std::size_t j) { pairs.emplace_back(i, j); });
  sweep(b, a, axis, false, [&](std::size_t j, std::size_t i) { pairs.emplace_back(i, j); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<IndexPair> overlaps_of_all_pairs(const std::vector<Extent>& a, const std::vector<Extent>& b) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      if (!apart(a[i], b[j])) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace cloth::test
