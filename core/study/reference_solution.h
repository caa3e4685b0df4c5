// The motion that errors are measured against, at fixed times, and how far it can be trusted.
//
// A smooth scene is solved twice, by two methods of different families that are not in the registry; what
// they differ by is the floor. With a limiter or contact the motion is defined by the loop itself (integrate,
// project), so that the reference is the loop with a far finer step, checked by a step twice as long.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "scene/scene.h"
#include "study/smooth_solvers.h"

namespace cloth {

/// Whether nothing but forces moves the cloth: no limiter and no contact at work in its loop.
bool is_smooth(const Scene& scene);

/// (x, v)' = (v, M^-1 f(x, v, t)) of a scene, all positions before all velocities.
class ClothMotion {
 public:
  explicit ClothMotion(const Scene& scene);
  ~ClothMotion();
  ClothMotion(const ClothMotion&) = delete;
  ClothMotion& operator=(const ClothMotion&) = delete;

  const ClothSystem& system() const { return system_; }
  Eigen::VectorXd start() const;
  void derivative(double time, const Eigen::VectorXd& y, Eigen::VectorXd& dy);
  ClothState state(double time, const Eigen::VectorXd& y) const;
  std::int64_t evaluations() const { return evaluations_; }

 private:
  struct Forces;
  ClothSystem system_;
  std::unique_ptr<Forces> forces_;
  std::int64_t evaluations_ = 0;
};

/// Between two sets of states at the same times.
struct StateDifference {
  double rms_position = 0;      ///< m, over particles and times
  double largest_position = 0;  ///< m, of any particle at any time
  double rms_velocity = 0;      ///< m/s
};
StateDifference difference(const std::vector<ClothState>& a, const std::vector<ClothState>& b);

struct ReferenceSolution {
  std::vector<ClothState> states;  ///< at horizon * k / samples, k = 1 .. samples
  StateDifference floor;           ///< between the two solutions
  double excited_frequency = 0;    ///< 1/s, see below; 0 where not smooth
  double largest_kinetic = 0;      ///< J, of `states`
  bool smooth = true;
  std::string first, second;     ///< what solved it, and what checked it
  std::int64_t evaluations = 0;  ///< of the force, by both
  std::string failure;           ///< not empty: there is no reference, and why

  /// Solved, though its states may not be kept.
  bool is_known() const { return !first.empty() && failure.empty(); }
};

/// Told the part that is done, from 0 to 1; false stops.
using ReferenceProgress = std::function<bool(double)>;

/// By collocation of order 12, which rounds least, checked by extrapolation at a tolerance of 1e-13. The
/// excited frequency is the root mean square of d(acceleration)/dt over that of the acceleration, masses as
/// weights: that of the one oscillation if there is one, else near the fastest of those that carry weight.
/// `stop` is looked at before each step.
ReferenceSolution solve_smooth(const Scene& scene, double horizon, int samples,
                               const ReferenceProgress& progress = {}, const StopTest& stop = {});

/// By the loop with Verlet in `steps` steps, checked with half as many. Precondition: 2 * samples divides
/// `steps`.
ReferenceSolution solve_by_loop(const Scene& scene, double horizon, int samples, std::int64_t steps,
                                const ReferenceProgress& progress = {}, const StopTest& stop = {});

/// The file of the states of a study's reference while the study is made, so that one that goes on need not
/// solve it again. Binary: a table would be three times as long, and no one reads it.
inline constexpr const char* reference_states_name = "work_precision_reference.f64";

/// One state after the other, of each all positions, then all velocities (m, m/s; x of all particles, then y,
/// then z), as doubles in the machine's order of bytes.
std::string bytes_of(const std::vector<ClothState>& states);

/// The states at horizon * k / samples back, to the bit; none where `bytes` are not exactly these.
std::vector<ClothState> states_from(const std::string& bytes, int particles, int samples, double horizon);

}  // namespace cloth
