#include "design/design.h"

#include <fmt/format.h>

#include <array>
#include <cassert>

#include "design/latin_hypercube.h"
#include "design/random_choice.h"
#include "design/sobol_sequence.h"

namespace cloth {
namespace {

/// SIZE_MAX where the product is larger.
std::size_t product(std::size_t a, std::size_t b) {
  return b != 0 && a > SIZE_MAX / b ? SIZE_MAX : a * b;
}

UnitPoints full_grid(std::size_t count, std::size_t dimensions) {
  UnitPoints points(rows_of_design(Design::grid, count, dimensions), UnitPoint(dimensions, 0.5));
  for (std::size_t i = 0; i < points.size() && count > 1; ++i) {
    std::size_t rest = i;
    for (std::size_t j = dimensions; j-- > 0; rest /= count)
      points[i][j] = static_cast<double>(rest % count) / static_cast<double>(count - 1);
  }
  return points;
}

UnitPoints saltelli_rows(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  const UnitPoints both = sobol_sequence(count, digital_shifts(2 * dimensions, seed));
  UnitPoints points;
  points.reserve(count * (dimensions + 2));
  for (const UnitPoint& row : both) {
    const auto middle = row.begin() + static_cast<std::ptrdiff_t>(dimensions);
    const UnitPoint a(row.begin(), middle), b(middle, row.end());
    points.push_back(a);
    points.push_back(b);
    for (std::size_t j = 0; j < dimensions; ++j) {
      points.push_back(a);
      points.back()[j] = b[j];
    }
  }
  return points;
}

UnitPoints morris_trajectories(std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  constexpr std::array<double, morris_levels> levels{0, 1.0 / 3.0, 2.0 / 3.0, 1};
  SplitMix random(seed);
  UnitPoints points;
  points.reserve(count * (dimensions + 1));
  for (std::size_t r = 0; r < count; ++r) {
    std::vector<std::size_t> level(dimensions);
    for (std::size_t& at : level) at = choice_below(random, morris_levels);
    const auto add = [&] {
      points.emplace_back(dimensions);
      for (std::size_t j = 0; j < dimensions; ++j) points.back()[j] = levels[level[j]];
    };
    add();
    for (const std::size_t j : random_order(random, dimensions)) {
      level[j] = (level[j] + 2) % morris_levels;  // up by 2/3 from the lower two levels, down from the others
      add();
    }
  }
  return points;
}

}  // namespace

std::size_t rows_of_design(Design design, std::size_t count, std::size_t dimensions) {
  if (design == Design::saltelli) return product(count, dimensions + 2);
  if (design == Design::morris) return product(count, dimensions + 1);
  if (design != Design::grid) return count;
  std::size_t rows = 1;
  for (std::size_t j = 0; j < dimensions && rows > 0 && rows < SIZE_MAX && count != 1; ++j)
    rows = product(rows, count);
  return rows;
}

std::string broken_design_rule(Design design, std::size_t count, std::size_t dimensions) {
  constexpr std::size_t most_rows = 10'000'000;
  if (dimensions < 1) return "needs at least one parameter";
  if (count < 1) return "needs a count of at least 1";
  const std::size_t sequences = design == Design::saltelli ? 2 * dimensions : dimensions;
  if ((design == Design::sobol || design == Design::saltelli) && sequences > max_sobol_dimensions)
    return fmt::format("takes at most {} parameters", max_sobol_dimensions / (sequences / dimensions));
  if (rows_of_design(design, count, dimensions) > most_rows)
    return fmt::format("would have more than {} points", most_rows);
  return "";
}

UnitPoints unit_design(Design design, std::size_t count, std::size_t dimensions, std::uint64_t seed) {
  assert(broken_design_rule(design, count, dimensions).empty());
  switch (design) {
    case Design::grid:
      return full_grid(count, dimensions);
    case Design::latin_hypercube:
      return latin_hypercube(count, dimensions, seed);
    case Design::sobol:
      return sobol_sequence(count, digital_shifts(dimensions, seed));
    case Design::saltelli:
      return saltelli_rows(count, dimensions, seed);
    case Design::morris:
      return morris_trajectories(count, dimensions, seed);
  }
  return {};
}

}  // namespace cloth
