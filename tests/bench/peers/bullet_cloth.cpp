#include "bench/peers/bullet_cloth.h"

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>

namespace cloth::peers {
namespace {

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

Vec3 from_bullet(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

bool is_links(BulletModel model) {
  return model == BulletModel::links || model == BulletModel::links_by_stiffness;
}

}  // namespace

double links_part(double stiffness, double time_step, double inverse_mass, int passes) {
  const double a = time_step * time_step * stiffness * inverse_mass;
  return -std::expm1(-std::log1p(a) / passes);  // 1 - (1 - a / (1 + a))^(1 / passes)
}

std::string broken_bullet_rule(const SpringList& list) {
  double stretch = -1, bend = -1;
  for (const ListedSpring& spring : list.springs) {
    double& stiffness = spring.bends ? bend : stretch;
    if (stiffness < 0) stiffness = spring.stiffness;
    if (stiffness != spring.stiffness)
      return "Bullet's springs have one stiffness in a body, and one for bending: structural and shear "
             "springs "
             "must be equally stiff";
  }
  return "";
}

/// Bullet's solver, whose limits no call of its own sets.
class BulletNewton : public btDeformableBodySolver {
 public:
  explicit BulletNewton(int iterations) {
    m_maxNewtonIterations = iterations;
    m_newtonTolerance = static_cast<btScalar>(1e-9);  // N s
  }
};

struct BulletCloth::World {
  World(const SpringList& list, const BulletSettings& chosen) : settings(chosen) {
    btSoftBodyWorldInfo& info = is_links(settings.model) ? make_links_world() : make_springs_world();
    world->setGravity(to_bullet(list.gravity));
    info.m_gravity = to_bullet(list.gravity);
    body = new btSoftBody(&info);
    body->appendMaterial()->m_kLST = 1;
    add_particles(list);
    add_springs(list);
    body->m_cfg.collisions = 0;
    body->m_cfg.piterations = settings.iterations;
    body->setSelfCollision(false);
    body->setActivationState(DISABLE_DEACTIVATION);
    if (classic) classic->addSoftBody(body);
    if (deformable) {
      deformable->addSoftBody(body);
      add_forces(list);
    }
  }

  ~World() {
    if (classic) classic->removeSoftBody(body);
    if (deformable) deformable->removeSoftBody(body);
    delete body;
    world.reset();
  }

  btSoftBodyWorldInfo& make_links_world() {
    solver = std::make_unique<btSequentialImpulseConstraintSolver>();
    auto made =
        std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher, &broadphase, solver.get(), &configuration);
    classic = made.get();
    world = std::move(made);
    btSoftBodyWorldInfo& info = classic->getWorldInfo();
    info.m_broadphase = &broadphase;
    info.m_dispatcher = &dispatcher;
    return info;
  }

  btSoftBodyWorldInfo& make_springs_world() {
    const bool is_implicit = settings.model == BulletModel::springs_implicit;
    body_solver = std::make_unique<BulletNewton>(settings.iterations);
    auto of_constraints = std::make_unique<btDeformableMultiBodyConstraintSolver>();
    of_constraints->setDeformableSolver(body_solver.get());
    auto made = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
        &dispatcher, &broadphase, of_constraints.get(), &configuration, body_solver.get());
    solver = std::move(of_constraints);
    made->setImplicit(is_implicit);
    made->setLineSearch(false);
    made->setUseProjection(true);  // conjugate gradients that keep pins; what Bullet's own examples take
    deformable = made.get();
    world = std::move(made);
    return deformable->getWorldInfo();
  }

  void add_particles(const SpringList& list) {
    for (std::size_t i = 0; i < list.mass.size(); ++i) {
      body->appendNode(to_bullet(list.position[i]), static_cast<btScalar>(list.mass[i]));
      btSoftBody::Node& node = body->m_nodes[static_cast<int>(i)];
      node.m_v = node.m_vn = to_bullet(list.velocity[i]);
      node.index = static_cast<int>(i);
    }
  }

  void add_springs(const SpringList& list) {
    for (const ListedSpring& spring : list.springs) {
      body->appendLink(spring.a, spring.b, material_of(list, spring));
      btSoftBody::Link& link = body->m_links[body->m_links.size() - 1];
      link.m_rl = static_cast<btScalar>(spring.rest_length);
      link.m_c1 = link.m_rl * link.m_rl;
      link.m_bbending = spring.bends;
    }
    // Bullet would take the lengths at the first step for those at rest.
    body->updateLinkConstants();
    body->m_bUpdateRtCst = false;
  }

  btSoftBody::Material* material_of(const SpringList& list, const ListedSpring& spring) {
    if (settings.model != BulletModel::links_by_stiffness) return body->m_materials[0];
    double inverse_mass = 0;
    for (const int end : {spring.a, spring.b}) {
      const double mass = list.mass[static_cast<std::size_t>(end)];
      if (mass > 0) inverse_mass += 1 / mass;
    }
    const auto part = static_cast<btScalar>(
        links_part(spring.stiffness, settings.time_step, inverse_mass, settings.iterations));
    for (int k = 1; k < body->m_materials.size(); ++k)
      if (body->m_materials[k]->m_kLST == part) return body->m_materials[k];
    btSoftBody::Material* made = body->appendMaterial();
    made->m_kLST = part;
    return made;
  }

  void add_forces(const SpringList& list) {
    double stretch = 0, bend = 0;
    for (const ListedSpring& spring : list.springs) (spring.bends ? bend : stretch) = spring.stiffness;
    springs = std::make_unique<btDeformableMassSpringForce>(static_cast<btScalar>(stretch), btScalar(0), true,
                                                            bend);
    gravity = std::make_unique<btDeformableGravityForce>(to_bullet(list.gravity));
    deformable->addForce(body, springs.get());
    deformable->addForce(body, gravity.get());
  }

  BulletSettings settings;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  std::unique_ptr<btConstraintSolver> solver;
  std::unique_ptr<BulletNewton> body_solver;
  std::unique_ptr<btDeformableMassSpringForce> springs;
  std::unique_ptr<btDeformableGravityForce> gravity;
  std::unique_ptr<btDynamicsWorld> world;
  btSoftRigidDynamicsWorld* classic = nullptr;
  btDeformableMultiBodyDynamicsWorld* deformable = nullptr;
  btSoftBody* body = nullptr;
};

BulletCloth::BulletCloth(const SpringList& list, const BulletSettings& settings)
    : world_(std::make_unique<World>(list, settings)) {}

BulletCloth::~BulletCloth() = default;

void BulletCloth::step() {
  world_->world->stepSimulation(static_cast<btScalar>(world_->settings.time_step), 0);
}

void BulletCloth::copy_to(Vec3Field& position, Vec3Field& velocity) const {
  for (int i = 0; i < world_->body->m_nodes.size(); ++i) {
    const btSoftBody::Node& node = world_->body->m_nodes[i];
    position.set(static_cast<std::size_t>(i), from_bullet(node.m_x));
    velocity.set(static_cast<std::size_t>(i), from_bullet(node.m_v));
  }
}

std::vector<double> BulletCloth::masses() const {
  std::vector<double> masses;
  for (int i = 0; i < world_->body->m_nodes.size(); ++i) {
    const auto inverse = static_cast<double>(world_->body->m_nodes[i].m_im);
    masses.push_back(inverse > 0 ? 1 / inverse : 0);
  }
  return masses;
}

std::string BulletCloth::version() {
  return std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100) +
         (sizeof(btScalar) == sizeof(double) ? ", double precision" : ", single precision");
}

}  // namespace cloth::peers
