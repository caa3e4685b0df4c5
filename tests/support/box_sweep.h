// Which of many boxes overlap, for the checker of crossings: the boxes are sorted along one axis and swept.
// Nothing of the engine's hierarchies; with all pairs looked at beside it, as what it must agree with.
#pragma once

#include <array>
#include <utility>
#include <vector>

namespace cloth::test {

struct Extent {
  std::array<double, 3> least, most;
};

/// Without a point in common: boxes that touch are not apart.
inline bool apart(const Extent& a, const Extent& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a.most[k] < b.least[k] || b.most[k] < a.least[k]) return true;
  return false;
}

/// Around all of them; of none, an extent that is apart from every other.
Extent hull_of(const std::vector<Extent>& boxes);

/// Indices of a and b.
using IndexPair = std::pair<std::size_t, std::size_t>;

/// Every pair of a box of `a` and one of `b` that are not apart, in ascending order. No coordinate may be
/// NaN.
std::vector<IndexPair> overlaps_by_sweep(const std::vector<Extent>& a, const std::vector<Extent>& b);

/// The same.
std::vector<IndexPair> overlaps_of_all_pairs(const std::vector<Extent>& a, const std::vector<Extent>& b);

}  // namespace cloth::test
