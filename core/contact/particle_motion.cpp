#include "contact/particle_motion.h"

#include <algorithm>

#include "contact/motion_kernels.h"
#include "kernels/in_shares.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

Components components_of(const Vec3Field& field) {
  return {field.x(), field.y(), field.z()};
}

}  // namespace

double find_distances(const Vec3Field& from, const Vec3Field& to, WorkerTeam* team,
                      std::vector<double>& distance) {
  const MotionKernels& kernels = active_kernels<MotionKernels>();
  distance.resize(from.size());
  std::vector<double> longest(team ? static_cast<std::size_t>(team->size()) : 1, 0.0);
  in_shares(team, from.size(), least_particles, [&](int share, std::size_t begin, std::size_t end) {
    const auto first = static_cast<long>(begin);
    longest[static_cast<std::size_t>(share)] =
        kernels.find_lengths(components_of(from).from(first), components_of(to).from(first),
                             static_cast<long>(end - begin), distance.data() + begin);
  });
  return *std::max_element(longest.begin(), longest.end());
}

void find_mean_velocity(const Vec3Field& from, const Vec3Field& to, double step, WorkerTeam* team,
                        Vec3Field& velocity) {
  if (velocity.size() != from.size()) velocity = Vec3Field(from.size());
  const MotionKernels& kernels = active_kernels<MotionKernels>();
  in_shares(team, 3 * from.size(), 3 * least_particles, [&](int, std::size_t begin, std::size_t end) {
    kernels.find_mean_speed(to.flat().data() + begin, from.flat().data() + begin, step,
                            static_cast<long>(end - begin), velocity.flat().data() + begin);
  });
}

bool any_differs(const Vec3Field& a, const Vec3Field& b, std::size_t begin, std::size_t end) {
  const MotionKernels& kernels = active_kernels<MotionKernels>();
  const auto differ = [&](const double* p, const double* q) {
    return kernels.differ(p + begin, q + begin, static_cast<long>(end - begin));
  };
  return differ(a.x(), b.x()) || differ(a.y(), b.y()) || differ(a.z(), b.z());
}

void copy(const Vec3Field& from, WorkerTeam* team, Vec3Field& to) {
  if (to.size() != from.size()) to = Vec3Field(from.size());
  in_shares(team, from.size(), least_particles, [&](int, std::size_t begin, std::size_t end) {
    std::copy(from.x() + begin, from.x() + end, to.x() + begin);
    std::copy(from.y() + begin, from.y() + end, to.y() + begin);
    std::copy(from.z() + begin, from.z() + end, to.z() + begin);
  });
}

bool are_finite(const Vec3Field& field) {
  return active_kernels<MotionKernels>().are_finite(field.flat().data(),
                                                    static_cast<long>(field.flat().size()));
}

}  // namespace cloth
