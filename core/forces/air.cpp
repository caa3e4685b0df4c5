#include "forces/air.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "cloth/normals.h"
#include "cloth/sums.h"
#include "forces/registry.h"
#include "kernels/in_shares.h"
#include "kernels/shared_job.h"

namespace cloth {

Vec3 wind_at(const Air& air, double time) {
  if (!air.gust) return air.wind;
  return air.wind * (1 + air.gust->amplitude * std::sin(2 * std::numbers::pi * air.gust->frequency * time));
}

Air wind_of(const Scene& scene) {
  return scene.air.value_or(Air{});
}

NodeCoefficient drag_along_normal(const Scene& scene) {
  if (const auto& m = scene.material) return {0, m->drag_normal / m->areal_density};
  return {scene.air ? scene.air->drag : 0, 0};
}

NodeCoefficient drag_along_cloth(const Scene& scene) {
  if (const auto& m = scene.material) return {0, m->drag_tangential / m->areal_density};
  return {scene.air ? scene.air->skin_friction : 0, 0};
}

double brush_falloff(const BrushGust& brush, const Vec3& position) {
  const Eigen::Vector4d clip =
      brush.world_to_screen * Eigen::Vector4d(position.x(), position.y(), position.z(), 1);
  if (!(clip.w() > 0)) return 0;  // behind the eye
  const double distance = (clip.head<2>() / clip.w() - brush.cursor).norm();
  if (!(distance < brush.radius)) return 0;
  return std::cos(0.5 * std::numbers::pi * distance / brush.radius);
}

namespace {

/// The change of brush_falloff where a particle at `position` moves by `shift`, to first order.
double brush_falloff_change(const BrushGust& brush, const Vec3& position, const Vec3& shift) {
  const Eigen::Vector4d clip =
      brush.world_to_screen * Eigen::Vector4d(position.x(), position.y(), position.z(), 1);
  if (!(clip.w() > 0)) return 0;
  const Eigen::Vector2d screen = clip.head<2>() / clip.w(), arm = screen - brush.cursor;
  const double distance = arm.norm();
  if (!(distance < brush.radius) || !(distance > 0)) return 0;
  const Eigen::Vector4d moved = brush.world_to_screen * Eigen::Vector4d(shift.x(), shift.y(), shift.z(), 0);
  const Eigen::Vector2d screen_change = (moved.head<2>() - screen * moved.w()) / clip.w();
  const double rate = 0.5 * std::numbers::pi / brush.radius;
  return -rate * std::sin(rate * distance) * arm.dot(screen_change) / distance;
}

class AirForce : public Force {
 public:
  /// `system` must outlive the force.
  AirForce(const Air& air, const NodeCoefficient& drag, const ClothSystem& system)
      : air_(air), drag_(drag), mass_(&system.mass) {}

  void set_brush(const std::optional<BrushGust>& brush) override { brush_ = brush; }
  void set_team(WorkerTeam* team, ThreadUse use) override { job_.set_team(team, use); }
  bool has_normals() const override { return true; }
  void hold_normals(bool hold) override { holds_normals_ = hold; }
  KernelCoverage join(SweepTerms& terms) const override {
    if (brush_ || (drag_.per_mass > 0) != terms.has_shares) return KernelCoverage::none;
    terms.air = &air_;
    terms.air_drag = drag_.of(terms.mass);
    return KernelCoverage::whole_steps;
  }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override {
    if (normal_.size() != position.size()) normal_ = Vec3Field(position.size());
    WorkerTeam* const team = job_.begin();
    if (!holds_normals_) find_normals(system, position, team);
    wind_ = wind_at(air_, time);
    if (wind_.squaredNorm() > 0)
      in_shares(team, position.size(), least_particles,
                [&](int, std::size_t begin, std::size_t end) { add_wind(begin, end, force); });
    job_.end();
    if (brush_) add_brush(position, force);
  }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    in_shares(job_.begin(), velocity.size(), least_particles,
              [&](int, std::size_t begin, std::size_t end) { add_drag(begin, end, velocity, product); });
    job_.end();
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.along_normal.each += drag_.each, damping.along_normal.per_mass += drag_.per_mass;
    damping.normal = &normal_;
    return true;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    const double *nx = normal_.x(), *ny = normal_.y(), *nz = normal_.z();
    const double *vx = velocity.x(), *vy = velocity.y(), *vz = velocity.z();
    const auto of_particle = [=, u = wind_](std::size_t i) {
      const double along = nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i];
      return along * (nx[i] * u.x() + ny[i] * u.y() + nz[i] * u.z() - along);
    };
    if (drag_.each > 0) power.air += drag_.each * ordered_sum(velocity.size(), of_particle);
    if (drag_.per_mass > 0)
      power.air += drag_.per_mass *
                   ordered_sum(velocity.size(), [&](std::size_t i) { return (*mass_)[i] * of_particle(i); });
    if (brush_ && brush_force_.size() == velocity.size())
      power.brush += dot(brush_force_.flat(), velocity.flat());
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    for (std::size_t i = 0; i < to.nodes.size(); ++i)
      to.nodes.add(i, block_along(0, weights.velocity * drag(i), normal_[i]));
  }
  bool has_asymmetric_part() const override { return !holds_normals_ || brush_.has_value(); }
  /// F = c_a (n . w) n with w = u - v: the normal turns with the positions, and a brush moves past them.
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override {
    if (turned_.size() != position.size()) turned_ = Vec3Field(position.size());
    if (holds_normals_)
      turned_.fill(0);
    else
      particle_normal_changes(system, position, direction, turned_);
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 n = normal_[i], dn = turned_[i];
      Vec3 w = wind_ - velocity[i], dw = Vec3::Zero();
      if (brush_) {
        w += brush_falloff(*brush_, position[i]) * brush_->velocity;
        dw = brush_falloff_change(*brush_, position[i], direction[i]) * brush_->velocity;
      }
      product.add(i, -drag(i) * ((dn.dot(w) + n.dot(dw)) * n + n.dot(w) * dn));
    }
  }

 private:
  static constexpr std::size_t least_particles = 2048;  ///< worth a thread of their own

  void find_normals(const ClothSystem& system, const Vec3Field& position, WorkerTeam* team) {
    if (system.is_mesh()) return particle_normals(system, position, normal_);
    const auto rows = static_cast<std::size_t>(system.rows);
    in_shares(team, rows, least_particles / static_cast<std::size_t>(system.columns) + 1,
              [&](int, std::size_t begin, std::size_t end) {
                particle_normals_of_rows(static_cast<int>(begin), static_cast<int>(end), system.rows,
                                         system.columns, position, normal_);
              });
  }
  /// Of particles [begin, end).
  void add_wind(std::size_t begin, std::size_t end, Vec3Field& force) const {
    const double *nx = normal_.x(), *ny = normal_.y(), *nz = normal_.z();
    double *fx = force.x(), *fy = force.y(), *fz = force.z();
    const double* const mass = mass_->data();
    const NodeCoefficient drag = drag_;
    const double ux = wind_.x(), uy = wind_.y(), uz = wind_.z();
#pragma GCC ivdep
    for (std::size_t i = begin; i < end; ++i) {
      const double push = drag.of(mass[i]) * (nx[i] * ux + ny[i] * uy + nz[i] * uz);
      fx[i] += push * nx[i], fy[i] += push * ny[i], fz[i] += push * nz[i];
    }
  }
  void add_drag(std::size_t begin, std::size_t end, const Vec3Field& velocity, Vec3Field& product) const {
    const double *nx = normal_.x(), *ny = normal_.y(), *nz = normal_.z();
    const double *vx = velocity.x(), *vy = velocity.y(), *vz = velocity.z();
    double *px = product.x(), *py = product.y(), *pz = product.z();
    const double* const mass = mass_->data();
    const NodeCoefficient drag = drag_;
#pragma GCC ivdep
    for (std::size_t i = begin; i < end; ++i) {
      const double along = drag.of(mass[i]) * (nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i]);
      px[i] += along * nx[i], py[i] += along * ny[i], pz[i] += along * nz[i];
    }
  }

  void add_brush(const Vec3Field& position, Vec3Field& force) {
    if (brush_force_.size() != position.size()) brush_force_ = Vec3Field(position.size());
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 n = normal_[i];
      const Vec3 push = drag(i) * brush_falloff(*brush_, position[i]) * n.dot(brush_->velocity) * n;
      brush_force_.set(i, push);
      force.add(i, push);
    }
  }

  double drag(std::size_t i) const {
    return drag_.of((*mass_)[i]);
  }

  Air air_;
  NodeCoefficient drag_;
  const std::vector<double>* mass_;
  std::optional<BrushGust> brush_;
  Vec3 wind_{0, 0, 0};  ///< m/s, at the time of the last update
  Vec3Field normal_;
  bool holds_normals_ = false;
  mutable SharedJob job_;     ///< an evaluation
  mutable Vec3Field turned_;  ///< scratch
  Vec3Field brush_force_;     ///< N, sized only once a brush is used
};

StageInfo wind_stage(const Scene& scene) {
  if (drag_along_normal(scene).is_zero() && drag_along_cloth(scene).is_zero())
    return {"wind", false, "there is no air to blow"};
  if (!scene.air) return {"wind", false, "the scene has no \"air\": the air only drags"};
  if (!(scene.air->wind.squaredNorm() > 0)) return {"wind", false, "air.wind is 0: the air only drags"};
  const bool gusts = scene.air->gust && scene.air->gust->amplitude > 0;
  return {"wind", true,
          fmt::format("{:.4g} m/s{}", scene.air->wind.norm(), gusts ? " with gusts" : ", steady")};
}

}  // namespace

ForceEntry air_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            const NodeCoefficient drag = drag_along_normal(scene);
            if (drag.is_zero()) return nullptr;
            return std::make_unique<AirForce>(wind_of(scene), drag, system);
          },
          .work = &Work::air,
          .explain =
              [](const Scene& scene, const ClothSystem&) {
                return std::vector{coefficient_stage("air drag", scene, normal_drag_path(scene)),
                                   wind_stage(scene)};
              }};
}

}  // namespace cloth
