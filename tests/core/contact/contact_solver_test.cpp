#include "contact/contact_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/instruction_set.h"
#include "kernels/worker_team.h"
#include "support/random.h"

namespace cloth::test::contact_solver_test {
namespace {

ContactConstraint on_floor(int particle, double friction) {
  ContactConstraint contact;
  contact.count = 1;
  contact.particle[0] = particle;
  contact.weight[0] = 1;
  contact.friction = friction;
  contact.mobility = 1;
  return contact;
}

TEST(ContactSolver, PushesToTheBoundAndNoFurther) {
  Vec3Field value(2);
  value.set(0, {1, -2, 3});
  value.set(1, {1, 2, 3});
  std::vector<ContactConstraint> contacts{on_floor(0, 0), on_floor(1, 0)};
  ContactSolver().solve(contacts, {1, 1}, {.sweeps = 10}, value);
  EXPECT_EQ(value[0], Vec3(1, 0, 3));
  EXPECT_EQ(value[1], Vec3(1, 2, 3));
  EXPECT_EQ(contacts[0].normal_impulse, 2);
  EXPECT_EQ(contacts[1].normal_impulse, 0);
}

TEST(ContactSolver, RubsUpToFrictionTimesThePush) {
  Vec3Field value(1);
  value.set(0, {3, -2, 4});
  std::vector<ContactConstraint> contacts{on_floor(0, 0.5)};
  ContactSolver().solve(contacts, {1}, {.sweeps = 10}, value);
  EXPECT_LE((value[0] - Vec3(3 * 0.8, 0, 4 * 0.8)).norm(), 1e-15);  // 1 of 5 is lost
}

TEST(ContactSolver, SticksWhereFrictionCouldTakeMore) {
  Vec3Field value(1);
  value.set(0, {0.3, -2, 0.4});
  std::vector<ContactConstraint> contacts{on_floor(0, 0.5)};
  contacts[0].rest = {0.1, 7, 0};
  ContactSolver().solve(contacts, {1}, {.sweeps = 10}, value);
  EXPECT_LE((value[0] - Vec3(0.1, 0, 0)).norm(), 1e-15);
}

TEST(ContactSolver, SharesAPushByInverseMassAndWeight) {
  Vec3Field value(2);
  value.set(0, {0, -1, 0});
  value.set(1, {0, -1, 0});
  ContactConstraint contact = on_floor(0, 0);
  contact.count = 2;
  contact.particle = {0, 1};
  contact.weight = {0.5, 0.5};
  const std::vector<double> inverse_mass{3, 1};
  contact.mobility = mobility_of(contact, inverse_mass);
  EXPECT_EQ(contact.mobility, 1);
  std::vector<ContactConstraint> contacts{contact};
  ContactSolver().solve(contacts, inverse_mass, {.sweeps = 10}, value);
  EXPECT_LE((value[0] - Vec3(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LE((value[1] - Vec3(0, -0.5, 0)).norm(), 1e-15);
}

TEST(ContactSolver, LeavesWhatCannotMove) {
  Vec3Field value(1);
  value.set(0, {0, -1, 0});
  ContactConstraint contact = on_floor(0, 0);
  contact.mobility = mobility_of(contact, {0});
  std::vector<ContactConstraint> contacts{contact};
  ContactSolver().solve(contacts, {0}, {.sweeps = 10}, value);
  EXPECT_EQ(value[0], Vec3(0, -1, 0));
}

TEST(ContactSolver, TakesAPushBackThatAnotherMadeNeedless) {
  Vec3Field value(1);
  value.set(0, {0, -1, 0});
  ContactConstraint steep = on_floor(0, 0), flat = on_floor(0, 0);
  flat.bound = 2;
  steep.normal = Vec3(1, 1, 0).normalized();
  std::vector<ContactConstraint> contacts{steep, flat};
  ContactSolver().solve(contacts, {1}, {.sweeps = 100}, value);
  EXPECT_LE((value[0] - Vec3(0, 2, 0)).norm(), 1e-12) << value[0].transpose();
  EXPECT_EQ(contacts[0].normal_impulse, 0);
}

/// The same contact twice, the second a little tighter: in every sweep the first gives up a thousandth of its
/// impulse and the second takes it over, and the particle is where it was.
TEST(ContactSolver, EndsWhereTwinsHandAnImpulseToAndFroAndNothingMoves) {
  Vec3Field value(1);
  value.set(0, {0, -1, 0});
  std::vector<ContactConstraint> contacts{on_floor(0, 0), on_floor(0, 0)};
  contacts[0].normal_impulse = 1, contacts[1].bound = 1e-3;
  apply_impulses(contacts[0], {1}, value);
  const int sweeps = ContactSolver().solve(contacts, {1}, {.sweeps = 1000, .tolerance = 1e-9}, value);
  EXPECT_LE(sweeps, 10);
  EXPECT_NEAR(value[0].y(), 1e-3, 1e-12);
  EXPECT_NEAR(contacts[0].normal_impulse + contacts[1].normal_impulse, 1.001, 1e-12);
}

/// A row of contacts of neighbours, where a sweep carries a change to the next one.
TEST(ContactSolver, SolvesAChainToWhatAllItsSweepsWouldLeave) {
  constexpr int count = 12;
  std::vector<double> inverse_mass(count, 1.0);
  inverse_mass[0] = 0;
  Vec3Field value(count);
  for (std::size_t i = 0; i < count; ++i) value.set(i, {0, -0.1 * static_cast<double>(i * i), 0});
  std::vector<ContactConstraint> contacts;
  for (int k = 1; k < count; ++k) {
    ContactConstraint contact = on_floor(k, 0);
    contact.count = 2, contact.particle = {k, k - 1}, contact.weight = {1, -1};
    contact.mobility = mobility_of(contact, inverse_mass);
    contacts.push_back(contact);
  }
  ContactSolver().solve(contacts, inverse_mass, {.sweeps = 10000, .tolerance = 1e-13}, value);
  double apart = 0;
  for (const ContactConstraint& contact : contacts) {
    const double gap = contact.normal.dot(contact.point(value));
    EXPECT_GE(gap, -1e-10);
    EXPECT_LE(std::abs(gap * contact.normal_impulse), 1e-9) << "an impulse where nothing touches";
    apart += contact.normal_impulse;
  }
  EXPECT_GT(apart, 1);
}

/// More contacts of a particle than the 64 colours that are kept as bits.
TEST(ContactSolver, SolvesManyContactsOfOneParticle) {
  constexpr int count = 200;
  const std::vector<double> inverse_mass(count + 1, 1.0);
  Vec3Field value(count + 1);
  for (std::size_t i = 0; i <= count; ++i) value.set(i, {0, -static_cast<double>(i), 0});
  std::vector<ContactConstraint> contacts;
  for (int k = 1; k <= count; ++k) {  // each neighbour above the same particle, which may give way
    ContactConstraint contact = on_floor(k, 0);
    contact.count = 2, contact.particle = {k, 0}, contact.weight = {1, -1};
    contact.mobility = mobility_of(contact, inverse_mass);
    contacts.push_back(contact);
  }
  ContactSolver().solve(contacts, inverse_mass, {.sweeps = 100000, .tolerance = 1e-12}, value);
  double momentum = 0;
  for (std::size_t i = 0; i <= count; ++i) momentum += value[i].y();
  EXPECT_NEAR(momentum, -0.5 * count * (count + 1), 1e-6);
  for (const ContactConstraint& contact : contacts) {
    const double gap = contact.normal.dot(contact.point(value));
    EXPECT_GE(gap, -1e-6);
    EXPECT_LE(std::abs(gap * contact.normal_impulse), 1e-4);
  }
}

/// Particles that stand on each other in a row: the push at one end reaches those that were left out.
TEST(ContactSolver, LeavesOutContactsThatAreFarUntilOthersBringThemNear) {
  constexpr int count = 20;
  std::vector<double> inverse_mass(count, 1.0);
  Vec3Field start(count);
  for (std::size_t i = 0; i < count; ++i) start.set(i, {0, 1.5 * static_cast<double>(i), 0});
  std::vector<ContactConstraint> contacts{on_floor(0, 0.3)};
  contacts[0].bound = 2;
  for (int k = 1; k < count; ++k) {
    ContactConstraint contact = on_floor(k, 0.3);
    contact.count = 2, contact.particle = {k, k - 1}, contact.weight = {1, -1};
    contact.bound = 1, contact.mobility = mobility_of(contact, inverse_mass);
    contacts.push_back(contact);
  }
  SolveLimits limits{.sweeps = 10000, .tolerance = 1e-13};
  Vec3Field all = start, few = start;
  std::vector<ContactConstraint> of_all = contacts, of_few = contacts;
  ContactSolver solver;
  solver.solve(of_all, inverse_mass, limits, all);
  limits.margin = 0.1;
  solver.solve(of_few, inverse_mass, limits, few);
  EXPECT_GT(all[3].y(), start[3].y() + 0.1) << "nothing is pushed so far";
  for (std::size_t i = 0; i < count; ++i) EXPECT_LE((all[i] - few[i]).norm(), 1e-10) << i;
  for (std::size_t c = 0; c < contacts.size(); ++c)
    EXPECT_NEAR(of_all[c].normal_impulse, of_few[c].normal_impulse, 1e-10) << c;
}

TEST(ContactSolver, SolvesNothingAgainWhereThereWasNothing) {
  ContactSolver solver;
  std::vector<ContactConstraint> contacts{on_floor(0, 0), on_floor(1, 0), on_floor(1, 0)}, none;
  Vec3Field value(2);
  value.set(0, {0, -1, 0}), value.set(1, {0, -1, 0});
  solver.solve(contacts, {1, 1}, {.sweeps = 10}, value);
  Vec3Field later(2);
  later.set(0, {0, -3, 0}), later.set(1, {0, -3, 0});
  solver.solve(none, {1, 1}, {.sweeps = 10}, later);
  solver.solve_again(none, {1, 1}, {.sweeps = 10}, later);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(later[i], Vec3(0, -3, 0));
}

/// Contacts of up to four particles each, some of them pinned, of some particles many.
TEST(ContactSolver, GivesTheSameBitsOnEveryInstructionSet) {
  constexpr int particles = 60, count = 300;
  Random random;
  std::vector<double> inverse_mass;
  for (int i = 0; i < particles; ++i) inverse_mass.push_back(i % 7 == 0 ? 0 : random.uniform(1, 100));
  const Vec3Field start = random.field(particles, 1);
  std::vector<ContactConstraint> contacts;
  for (int c = 0; c < count; ++c) {
    ContactConstraint contact;
    contact.count = random.integer(1, 4);
    const int first = random.integer(0, particles - 1);
    for (int k = 0; k < contact.count; ++k) {
      contact.particle[at(k)] = (first + 3 * k) % particles;
      contact.weight[at(k)] = random.uniform(-1, 1);
    }
    contact.normal = random.vector(1).normalized(), contact.rest = random.vector(1);
    contact.bound = random.uniform(-1, 1), contact.friction = random.uniform(0, 1);
    contact.mobility = mobility_of(contact, inverse_mass);
    contacts.push_back(contact);
  }
  std::optional<Vec3Field> first;
  for (const InstructionSet set : supported_instruction_sets()) {
    set_instruction_set(set);
    std::vector<ContactConstraint> own = contacts;
    Vec3Field value = start;
    ContactSolver().solve(own, inverse_mass, {.sweeps = 50, .tolerance = 1e-9}, value);
    if (!first) first = value;
    for (std::size_t i = 0; i < particles; ++i)
      EXPECT_EQ(Vec3(value[i]), Vec3((*first)[i])) << name_of(set) << ", particle " << i;
  }
  set_instruction_set(std::nullopt);
  EXPECT_GT(((*first)[1] - start[1]).norm(), 0.01) << "nothing happens";
}

/// Contacts that share no particle that they move: neither what has weight 0 nor what is pinned counts.
TEST(ContactSolver, GivesTheSameBitsToManyThreadsWhereContactsMeetInParticlesThatTheyDoNotMove) {
  constexpr int count = 4000;
  Random random;
  std::vector<double> inverse_mass(2 * count, 0.0);  // of each contact one that it moves, and pinned ones
  for (int c = 0; c < count; ++c) inverse_mass[at(c)] = random.uniform(1, 100);
  std::vector<ContactConstraint> contacts;
  for (int c = 0; c < count; ++c) {
    ContactConstraint contact;
    contact.count = 4;
    contact.particle = {c, random.integer(0, count - 1), random.integer(0, count - 1),
                        random.integer(count, 2 * count - 1)};
    contact.weight = {random.uniform(0.5, 1), 0, 0, random.uniform(-1, 1)};
    contact.bound = random.uniform(-1, 1), contact.friction = random.uniform(0, 1);
    contact.mobility = mobility_of(contact, inverse_mass);
    contacts.push_back(contact);
  }
  const Vec3Field start = random.field(2 * count, 1);
  const auto solved = [&](WorkerTeam* team) {
    std::vector<ContactConstraint> own = contacts;
    Vec3Field value = start;
    ContactSolver solver;
    solver.set_team(team);
    EXPECT_EQ(solver.solve(own, inverse_mass, {.sweeps = 50, .tolerance = 1e-9}, value), 1);
    return value;
  };
  const Vec3Field alone = solved(nullptr);
  EXPECT_NE(alone, start);
  WorkerTeam team(3);
  for (int repeat = 0; repeat < 100; ++repeat) ASSERT_EQ(solved(&team), alone) << repeat;
}

}  // namespace
}  // namespace cloth::test::contact_solver_test
