// Obstacles as tests of single particles: what is inside is put on the nearest point of the surface (sphere:
// report, Eq. (16); box: only the coordinate of least penetration moves) and its velocity answers if it goes
// inward.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "contact/contact_mark.h"
#include "contact/contact_memory.h"
#include "contact/contact_report.h"
#include "scene/obstacle_shape.h"

namespace cloth {

/// The velocity after contact, only changed if it goes inward. coulomb: v_n -> -restitution v_n, and the
/// tangential part loses up to friction |change of v_n|. reflect (report, Eq. (17)): v -> friction (v - 2 v_n
/// n).
Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity);

/// The same, where contact was come to with `approach` in m/s: the rest of the inward speed is no blow but
/// the load of a step, which restitution does not give back. With 0 nothing bounces. What else presses it
/// against the surface, `press` in m/s, counts for friction.
Vec3 contact_velocity(const Obstacle& obstacle, const Vec3& normal, const Vec3& velocity, double approach,
                      double normal_load = 0);

/// The obstacle with its surface `length` m further out.
Obstacle grown(Obstacle obstacle, double length);

/// A particle on an obstacle's surface.
struct HeldParticle {
  std::size_t particle = 0, obstacle = 0;
  Vec3 normal{0, 0, 0};    ///< outward
  double normal_load = 0;  ///< N s, of the springs against the surface, beyond what the particle came with
};

/// Where the particles of a step come to when their springs give way to contact (contact/stiff_contact.h).
struct ConstrainedStep {
  Vec3Field position;              ///< m
  double weight = 0;               ///< s; velocities change by displacements over it
  std::vector<HeldParticle> held;  ///< in order of the particles
};

/// Of the step that contact follows.
struct ContactBegin {
  const Vec3Field& position;                     ///< m, as it began
  const Vec3Field& velocity;                     ///< m/s
  double step = 0;                               ///< s
  ContactMemory& memory;                         ///< of the last step, and then of this one
  const ConstrainedStep* constrained = nullptr;  ///< without it each particle goes to the nearest surface
};

/// A particle that moves further in a step than an obstacle is thick: it can pass between two steps unseen.
struct TunnellingRisk {
  int particle = 0;
  std::size_t obstacle = 0;
  double travel = 0;     ///< m, |v| h
  double thickness = 0;  ///< m: a ball's diameter, a box's smallest side
};

/// The particle that moves furthest, if that is further than the thinnest obstacle. Planes have no other
/// side.
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

  /// Particles that `apply` would move.
  bool touches(const ClothSystem& system, const ClothState& state) const;

  /// Whether any of them is inside by more than rounding.
  bool is_inside(const ClothSystem& system, const Vec3Field& position) const;

  const std::vector<Obstacle>& obstacles() const { return obstacles_; }

  /// Appends the particles that lie on an obstacle's surface, to rounding.
  void append_marks(const Vec3Field& position, std::vector<ContactMark>& marks) const;

 private:
  /// Where and how fast the integrator let a particle go.
  struct Integrated {
    Vec3 position{0, 0, 0}, velocity{0, 0, 0};  ///< m, m/s
  };
  /// A free particle on its way through a step of contact.
  struct Particle {
    std::size_t index = 0;
    Integrated integrated;
    std::span<const HeldParticle> held;  ///< of it
    Vec3 before{0, 0, 0};                ///< m/s, as the step began, or what the obstacle before has answered
  };
  struct Touched {
    SurfacePoint surface;
    double normal_load = 0;  ///< N s
  };
  static void give_way(const Particle& particle, const ConstrainedStep& constrained, ClothState& state);
  std::optional<Touched> touched(std::size_t obstacle, const Particle& particle, const Vec3& position,
                                 bool constrained) const;
  bool touch(const ClothSystem& system, Particle& particle, const ContactBegin& begin, ClothState& state,
             ContactReport& report) const;
  double approach_of(std::size_t particle, const Vec3& normal, const ContactBegin& begin,
                     const Integrated& integrated) const;

  std::vector<Obstacle> obstacles_;
  double gravity_ = 0;  ///< m/s^2
};

}  // namespace cloth
