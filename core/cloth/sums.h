// Sums in a fixed order that still vectorises: eight partial sums, added pairwise at the end. The same bits
// for the same input on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace cloth {

/// sum of term(k) for k in [0, count)
template <class Term>
double ordered_sum(std::size_t count, Term term) {
  constexpr std::size_t lanes = 8;
  std::array<double, lanes> partial{};
  const std::size_t blocks = count / lanes * lanes;
  for (std::size_t k = 0; k < blocks; k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) partial[lane] += term(k + lane);
  for (std::size_t k = blocks; k < count; ++k) partial[k - blocks] += term(k);
  return ((partial[0] + partial[1]) + (partial[2] + partial[3])) +
         ((partial[4] + partial[5]) + (partial[6] + partial[7]));
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  return ordered_sum(a.size(), [pa = a.data(), pb = b.data()](std::size_t k) { return pa[k] * pb[k]; });
}

}  // namespace cloth
