// Bending elements: a few particles whose weighted sum vanishes on a flat cloth and has the energy
//
//     E = 1/2 k |s|^2,   s = sum_p c_p x_p,   sum_p c_p = 0
//
// Along a line of a grid s is the second difference x_- - 2 x + x_+, in a cell the twist x_a - x_b - x_d +
// x_c. The second derivative of E is constant, and E does not change when the cloth is moved or turned.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

/// `count` elements alike: the points of element e are the particles first + e + offset[p].
struct BendingRun {
  static constexpr std::size_t most_points = 12;
  int first = 0, count = 0;
  int points = 3;
  std::array<int, most_points> offset{};
  std::array<double, most_points> coefficient{};
  double stiffness = 0;  ///< k, N/m
  bool operator==(const BendingRun&) const = default;
};
using BendingRuns = std::vector<BendingRun>;

/// sum of E in J.
double bending_energy(const BendingRuns& runs, const Vec3Field& position);

/// result += scale * K field, K the second derivative of the energy in N/m: the force is -K x.
void add_bending_product(const BendingRuns& runs, double scale, const Vec3Field& field, Vec3Field& result);

/// field . K field. With velocities in m/s and a damping time in s: the power in W that damping takes, over
/// that time.
double bending_square(const BendingRuns& runs, const Vec3Field& field);

/// The same energy as a sum over pairs, E = sum 1/2 k_ij |x_i - x_j|^2 with k_ij = -k c_i c_j, of either
/// sign: visit(i, j, k_ij), element by element.
template <class Visit>
void for_each_bending_pair(const BendingRuns& runs, Visit visit) {
  for (const BendingRun& run : runs)
    for (int e = run.first; e < run.first + run.count; ++e)
      for (int p = 0; p < run.points; ++p)
        for (int q = p + 1; q < run.points; ++q) {
          const auto a = static_cast<std::size_t>(p), b = static_cast<std::size_t>(q);
          visit(static_cast<std::size_t>(e + run.offset[a]), static_cast<std::size_t>(e + run.offset[b]),
                -run.stiffness * run.coefficient[a] * run.coefficient[b]);
        }
}

}  // namespace cloth
