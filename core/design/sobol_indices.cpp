#include "design/bootstrap.h"
#include "design/sensitivity.h"

namespace cloth {
namespace {

/// The outputs of one row of A: f_A, f_B, then f_AB of each dimension.
using Row = std::span<const double>;

struct Moments {
  double mean = 0, variance = 0;
};

/// Over f_A and f_B of the rows that `drawn` counts.
Moments moments_of(const std::vector<Row>& rows, const std::vector<std::size_t>& drawn) {
  Moments moments;
  const double count = 2 * static_cast<double>(drawn.size());
  for (const std::size_t i : drawn) moments.mean += rows[i][0] + rows[i][1];
  moments.mean /= count;
  for (const std::size_t i : drawn)
    for (const double f : {rows[i][0], rows[i][1]})
      moments.variance += (f - moments.mean) * (f - moments.mean);
  moments.variance /= count - 1;
  return moments;
}

struct Indices {
  std::vector<double> first, total;
};

Indices indices_of(const std::vector<Row>& rows, const std::vector<std::size_t>& drawn,
                   std::size_t dimensions) {
  const Moments moments = moments_of(rows, drawn);
  const double scale = 1 / (moments.variance * static_cast<double>(drawn.size()));
  Indices found{std::vector<double>(dimensions), std::vector<double>(dimensions)};
  for (const std::size_t i : drawn)
    for (std::size_t j = 0; j < dimensions; ++j) {
      const double change = rows[i][2 + j] - rows[i][0];
      found.first[j] += (rows[i][1] - moments.mean) * change * scale;
      found.total[j] += change * change * scale / 2;
    }
  return found;
}

/// The rows whose runs all have a value, and what was left out.
std::vector<Row> whole_rows(std::span<const double> outputs, std::size_t length, SobolIndices& indices) {
  std::vector<Row> rows;
  for (std::size_t at = 0; at + length <= outputs.size(); at += length) {
    const Row row = outputs.subspan(at, length);
    const auto failed = static_cast<std::size_t>(
        std::count_if(row.begin(), row.end(), [](double value) { return !std::isfinite(value); }));
    indices.failed += failed;
    indices.left_out += failed > 0 ? 1 : 0;
    if (failed == 0) rows.push_back(row);
  }
  indices.rows = rows.size();
  return rows;
}

}  // namespace

SobolIndices sobol_indices(std::span<const double> outputs, std::size_t dimensions, std::uint64_t seed) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  SobolIndices indices;
  const std::vector<Row> rows = whole_rows(outputs, dimensions + 2, indices);
  indices.parameters.assign(dimensions, {{none, none, none}, {none, none, none}});
  std::vector<std::size_t> drawn(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) drawn[i] = i;
  if (rows.size() < 2) return indices;
  const Moments moments = moments_of(rows, drawn);
  indices.mean = moments.mean, indices.variance = moments.variance;
  if (!(moments.variance > 0)) return indices;

  const Indices found = indices_of(rows, drawn, dimensions);
  std::vector<std::vector<double>> firsts(dimensions), totals(dimensions);
  SplitMix random(seed);
  for (std::size_t b = 0; b < bootstrap_samples; ++b) {
    for (std::size_t& i : drawn) i = choice_below(random, rows.size());
    const Indices sample = indices_of(rows, drawn, dimensions);
    for (std::size_t j = 0; j < dimensions; ++j) {
      firsts[j].push_back(sample.first[j]);
      totals[j].push_back(sample.total[j]);
    }
  }
  for (std::size_t j = 0; j < dimensions; ++j) {
    const auto [first_low, first_high] = interval_of(firsts[j]);
    const auto [total_low, total_high] = interval_of(totals[j]);
    indices.parameters[j] = {{found.first[j], first_low, first_high},
                             {found.total[j], total_low, total_high}};
  }
  return indices;
}

}  // namespace cloth
