// The springs of any cloth in the order in which XPBD visits them: by colours, of which no two springs of one
// share a particle, so that the kernels (coloured_visits.h) visit those of a colour many at a time.
//
// A spring takes, in the order of the springs, the first colour that none has with which it shares a
// particle. Colour follows colour, and within one the order is that of the springs. Where colours have fewer
// than 16 springs on average, vectors would be half empty: there is one colour for each spring, which is the
// order of the springs. The order depends on the system alone.
#pragma once

#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "geometry/aligned.h"
#include "kernels/local_pass.h"

namespace cloth {

/// Numbers of springs of positive stiffness (for_each_spring() counts them), in the order of visits.
struct SpringOrder {
  std::vector<int> springs;
  std::vector<int>
      colour_begin;            ///< colour c has springs[colour_begin[c]] to springs[colour_begin[c + 1] - 1]
  bool fills_vectors = false;  ///< else the order is that of the springs, and colour_begin is empty
};
SpringOrder order_by_colours(const ClothSystem& system);

class ColouredSprings {
 public:
  ColouredSprings() = default;
  explicit ColouredSprings(const ClothSystem& system);
  /// Whether these are the springs of `system`, as it is now.
  bool describe(const ClothSystem& system) const { return springs_ == system.springs; }
  /// Whether vectors would be filled, or there is no spring.
  bool are_visited_by_vectors() const { return by_vectors_; }

  /// Dampers along springs: `each` (N s/m), and a damping time times the stiffness.
  struct Dampers {
    double each = 0, per_stiffness = 0;
    bool operator==(const Dampers&) const = default;
  };
  /// Substeps of `step` s follow; `mobility` (1/kg) is w of each particle, 0 where pinned.
  void begin(double step, const Dampers& dampers, const std::vector<double>& mobility);
  /// A substep from `position` (m) with the predicted `velocity` (m/s). `drag`: b of integrators/xpbd.h in
  /// kg^-1/2, or null. `keeps_impulses`: whether springs are visited more than once.
  void begin_substep(const Vec3Field& position, const Vec3Field& velocity, const Vec3Field* drag,
                     bool keeps_impulses);
  /// Visits every spring once. Returns, where it is `measured`, the largest squared change of a particle's
  /// velocity by a visit.
  double visit(bool measured);
  /// What the visits move, for those of other elements (kernels/projected_elements.h).
  kernels::ProjectedParticles& particles() { return pass_; }
  /// The velocities that the visits have changed.
  void give(Vec3Field& velocity) const;

 private:
  void store(const Vec3Field& field, AlignedDoubles& vectors) const;

  SpringRuns springs_;
  bool by_vectors_ = false;
  std::vector<int> first_, second_;  ///< 4 times the particle, in the order of visits, filled up
  std::vector<double> stiffness_, rest_length_;
  const kernels::LocalKernels* kernels_ = nullptr;
  kernels::ColouredProjection pass_;
  Dampers dampers_;
  std::vector<double> mobility_;  ///< and 0 of the particle that fills up
  std::vector<double> stretch_, tension_, damper_, turn_, both_;
  AlignedDoubles position_, velocity_, drag_;
  std::array<std::vector<double>, 3> impulse_;
};

}  // namespace cloth
