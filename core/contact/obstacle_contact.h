// Contact with obstacles particle by particle. A particle inside an obstacle is moved to the nearest point of
// the surface (sphere: report, Eq. (16); box: along the axis of least penetration), and its velocity changes
// by the contact law of the obstacle if it points inward.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "contact/contact_report.h"
#include "contact/touch_kernels.h"
#include "scene/obstacle_shape.h"

namespace cloth {

/// The velocity (m/s) after contact; unchanged if it does not point inward. With v_n its component along the
/// outward normal n: response "coulomb" replaces v_n by -restitution v_n and reduces the tangential part by
/// up to friction |change of v_n|; "reflect" gives friction (v - 2 v_n n) (report, Eq. (17)). Either way the
/// change beyond v_n = 0 is as much as returns no more energy than the contact takes: under a load that acts
/// during a step Eq. (17) would throw a particle at rest back in every step.
Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity);

/// The obstacle with its surface moved outward by `length` (m).
Obstacle grown(Obstacle obstacle, double length);

/// nullopt: BodyKind::surface, which has no inside.
std::optional<TouchSolid> solid_of(const Obstacle& obstacle);

/// A particle on an obstacle's surface.
struct HeldParticle {
  std::size_t particle = 0, obstacle = 0;
  Vec3 normal{0, 0, 0};    ///< outward
  double normal_load = 0;  ///< N s, impulse of the springs into the surface within the step
};

/// The positions at the end of a step that was solved with contact as a constraint (contact/stiff_contact.h).
struct ConstrainedStep {
  Vec3Field position;              ///< m
  double weight = 0;               ///< s; velocities change by displacement / weight
  std::vector<HeldParticle> held;  ///< in order of the particles
};

/// The beginning of the step whose result contact corrects.
struct ContactBegin {
  const Vec3Field& position;                     ///< m
  const Vec3Field& velocity;                     ///< m/s
  double step = 0;                               ///< s, length of the step
  ContactMemory& memory;                         ///< in: of the last step; out: of this one
  const ConstrainedStep* constrained = nullptr;  ///< null: particles are moved to the nearest surface point
};

/// A particle that moves further in a step than an obstacle is thick: it may pass through undetected.
struct TunnellingRisk {
  int particle = 0;
  std::size_t obstacle = 0;
  double travel = 0;     ///< m, |v| h
  double thickness = 0;  ///< m: a ball's diameter, a box's smallest side
};

/// The particle with the largest displacement, if that exceeds the thickness of the thinnest obstacle.
/// Planes, which have no far side, are ignored.
std::optional<TunnellingRisk> find_tunnelling(const std::vector<Obstacle>& obstacles,
                                              const ClothSystem& system, const ClothState& state,
                                              double time_step);

/// "particle 40 moves 2 m in a step and obstacle 0 is 0.01 m thick: it can pass it unseen"
std::string describe(const TunnellingRisk& risk);

class ObstacleContact {
 public:
  /// `gravity` in m/s^2.
  ObstacleContact(std::vector<Obstacle> obstacles, double gravity);

  ContactReport apply(const ClothSystem& system, const ContactBegin& begin, ClothState& state) const;

  /// Whether a free particle is inside an obstacle, so that `apply` would move it.
  bool touches(const ClothSystem& system, const ClothState& state) const;

  /// Whether a free particle is inside an obstacle by more than rounding.
  bool is_inside(const ClothSystem& system, const Vec3Field& position) const;

  const std::vector<Obstacle>& obstacles() const { return obstacles_; }

  /// Appends the particles that lie on an obstacle's surface, up to rounding.
  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const;

 private:
  /// Some particles that follow each other, as many as a TouchBlock has.
  struct Piece {
    std::size_t first = 0, count = 0;
    std::span<const HeldParticle> held;  ///< the surfaces that they lie on, in order of the particles
  };
  void respond(const ClothSystem& system, const ContactBegin& begin, const Piece& piece, TouchBlock& block,
               ClothState& state, ContactReport& report) const;
  static int find_held(std::size_t obstacle, const Piece& piece, TouchBlock& block);
  static void move_to_constrained(const ClothSystem& system, const ConstrainedStep& constrained,
                                  const Piece& piece, TouchBlock& block);

  std::vector<Obstacle> obstacles_;
  std::vector<std::optional<TouchSolid>> solids_;  ///< of each obstacle; nullopt: it has no inside
  bool rebounds_ = false;                          ///< an obstacle has restitution
  double gravity_ = 0;                             ///< m/s^2
};

}  // namespace cloth
