// A cloth of springs in Bullet: the same particles, masses, springs, rest lengths, pins and gravity as ours,
// in one of Bullet's two soft bodies.
//
// `springs`: btDeformableMultiBodyDynamicsWorld with btDeformableMassSpringForce, the same springs in N/m.
// Explicit it is semi-implicit Euler; implicit it is backward Euler by Newton's method with conjugate
// gradients. `links`: the classic btSoftBody of btSoftRigidDynamicsWorld, position based: each pass moves the
// ends of every link by the part kLST of what it is too long. That is another model: with passes without end
// it is inextensible whatever the step, and with few it depends on the step. kLST is a number in [0, 1], not
// N/m. `links_by_stiffness`: the same with kLST chosen so that one spring alone, in all passes together,
// moves as by backward Euler (links_part), by Clothlab, not by Bullet.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/peers/spring_list.h"

namespace cloth::peers {

enum class BulletModel { springs_explicit, springs_implicit, links, links_by_stiffness };
inline constexpr const char* bullet_model_names[] = {"springs-explicit", "springs-implicit", "links",
                                                     "links-by-stiffness"};

/// What Bullet does in a step.
struct BulletSettings {
  BulletModel model = BulletModel::springs_explicit;
  double time_step = 0;  ///< s
  int iterations = 1;    ///< passes over the links; at most so many of Newton's method
};

/// The kLST of each of `passes` passes of a link between inverse masses of the sum `inverse_mass` (1/kg), so
/// that together they move its ends by a / (1 + a) of what it is too long, a = h^2 k inverse_mass: what
/// backward Euler does to one spring alone. In [0, 1).
double links_part(double stiffness, double time_step, double inverse_mass, int passes);

class BulletCloth {
 public:
  /// Precondition: structural springs and those of shear are equally stiff, since Bullet knows two
  /// stiffnesses in a body, one of them for bending. See broken_bullet_rule.
  BulletCloth(const SpringList& springs, const BulletSettings& settings);
  ~BulletCloth();
  BulletCloth(const BulletCloth&) = delete;
  BulletCloth& operator=(const BulletCloth&) = delete;

  void step();
  void copy_to(Vec3Field& position, Vec3Field& velocity) const;
  std::vector<double> masses() const;  ///< kg; 0 where pinned

  /// "3.24, double precision"
  static std::string version();

 private:
  struct World;
  std::unique_ptr<World> world_;
};

/// Why this cloth cannot be made in Bullet as these springs; empty: it can.
std::string broken_bullet_rule(const SpringList& springs);

}  // namespace cloth::peers
