// Air, Eq. (4) of the report: F_i = c_a (n . (u - v_i)) n, with u the air's velocity at the particle: the
// wind, its gusts and the wind brush.
#pragma once

#include <optional>

#include "forces/force.h"
#include "scene/scene.h"

namespace cloth {

class AirForce : public Force {
 public:
  explicit AirForce(const Air& air) : air_(air) {}

  void set_brush(const std::optional<BrushGust>& brush) override { brush_ = brush; }
  SweptIn join(SweepTerms& terms) const override {
    if (brush_) return SweptIn::nothing;
    terms.air = &air_;
    return SweptIn::whole_steps;
  }

  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override;
  bool add_node_damping(NodeDamping& damping) const override;
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;
  bool has_asymmetric_part() const override { return true; }
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override;

 private:
  void add_brush(const Vec3Field& position, Vec3Field& force);

  Air air_;
  std::optional<BrushGust> brush_;
  Vec3 wind_{0, 0, 0};  ///< m/s, at the time of the last update
  Vec3Field normal_;
  Vec3Field brush_force_;  ///< N, sized only once a brush is used
};

/// wind * (1 + amplitude * sin(2 pi frequency t)), in m/s.
Vec3 wind_at(const Air& air, double time);

/// How much of the gust a particle at `position` feels: cos(pi/2 * r/radius) within the radius, else 0.
double brush_falloff(const BrushGust& brush, const Vec3& position);

/// The change of brush_falloff where a particle at `position` moves by `shift`, to first order.
double brush_falloff_change(const BrushGust& brush, const Vec3& position, const Vec3& shift);

}  // namespace cloth
