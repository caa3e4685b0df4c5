// Where a study puts its points: designs on the unit cube, each a function of its arguments alone, with the
// same bits on every machine. A point is a row of `dimensions` numbers in [0, 1].
//
//     const auto rows = unit_design(Design::saltelli, 1024, 5, seed);  // 1024 (5 + 2) rows
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cloth {

enum class Design { grid, latin_hypercube, sobol, saltelli, morris };
/// As files have it.
inline constexpr const char* design_names[] = {"grid", "latin-hypercube", "sobol", "saltelli", "morris"};
inline const char* name_of(Design design) {
  return design_names[static_cast<std::size_t>(design)];
}

using UnitPoint = std::vector<double>;
using UnitPoints = std::vector<UnitPoint>;

/// Morris' levels are 0, 1/3, 2/3, 1, and a step goes over two of them.
inline constexpr int morris_levels = 4;
inline constexpr double morris_step = 2.0 / 3.0;

/// The dimensions that Joe and Kuo's directions reach; `saltelli` takes two of them for each of its own.
inline constexpr std::size_t max_sobol_dimensions = 3667;

/// How many rows a design has. What `count` counts:
///   grid             values of each axis, both ends among them: count^dimensions rows
///   latin_hypercube  rows
///   sobol            rows; powers of 2 fill the cube evenly
///   saltelli         N, of N (dimensions + 2) rows; powers of 2 again
///   morris           trajectories, of dimensions + 1 rows each
/// SIZE_MAX where there are more than that.
std::size_t rows_of_design(Design design, std::size_t count, std::size_t dimensions);

/// The rule that the numbers break, or "" where there is such a design.
std::string broken_design_rule(Design design, std::size_t count, std::size_t dimensions);

/// The rows of a design, in this order:
///   grid             the last dimension changes fastest; `seed` does nothing; of one value: 0.5
///   latin_hypercube  of 50 hypercubes with points at random in their cells (McKay, Beckman and Conover 1979)
///                    the one whose closest points are farthest apart (Johnson, Moore and Ylvisaker 1990);
///                    of fewer beyond 2000 points, so that count^2 times their number stays at 2e8
///   sobol            the Sobol' sequence (Sobol' 1967) with the directions of Joe and Kuo (2008), its first
///                    point included (Owen 2021), under a digital shift (Lemieux 2009) drawn from `seed`
///   saltelli         for each i of N: row i of A, row i of B, and for each dimension j row i of A with
///   number
///                    j from B (Saltelli et al. 2010); A and B are halves of a Sobol' sequence
///   morris           for each trajectory a point on the levels, then one step in every dimension once, in a
///                    random order (Morris 1991)
/// A design with a larger count begins with the rows of a smaller one, but for grid and latin_hypercube.
/// Precondition: broken_design_rule(...) is empty.
UnitPoints unit_design(Design design, std::size_t count, std::size_t dimensions, std::uint64_t seed);

}  // namespace cloth
