// What continuous contact asks of all particles in every step (motion_kernels.h), in shares of a team.
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

class WorkerTeam;

/// Least number of particles that is worth a thread of its own, which has to fetch them first.
inline constexpr std::size_t least_particles = 2048;

/// m, of each particle; returns the longest. `team`: null is one thread.
double find_distances(const Vec3Field& from, const Vec3Field& to, WorkerTeam* team,
                      std::vector<double>& distance);

/// m/s, from one position (m) to another within `step` seconds.
void find_mean_velocity(const Vec3Field& from, const Vec3Field& to, double step, WorkerTeam* team,
                        Vec3Field& velocity);

/// Whether some particle in [begin, end) differs in any bit.
bool any_differs(const Vec3Field& a, const Vec3Field& b, std::size_t begin, std::size_t end);

/// Calls visit(i) for every particle that `a` and `b` give different values, ascending.
template <class Visit>
void visit_different(const Vec3Field& a, const Vec3Field& b, const Visit& visit) {
  constexpr std::size_t run = 64;
  for (std::size_t begin = 0; begin < a.size(); begin += run) {
    const std::size_t end = std::min(begin + run, a.size());
    if (!any_differs(a, b, begin, end)) continue;
    for (std::size_t i = begin; i < end; ++i)
      if (a[i] != b[i]) visit(i);
  }
}

bool are_finite(const Vec3Field& field);

/// to = from
void copy(const Vec3Field& from, WorkerTeam* team, Vec3Field& to);

}  // namespace cloth
