#include "contact/contact_solver.h"

#include <gtest/gtest.h>

#include <cmath>

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
  solve_contacts(contacts, {1, 1}, 10, 0, value);
  EXPECT_EQ(value[0], Vec3(1, 0, 3));
  EXPECT_EQ(value[1], Vec3(1, 2, 3));
  EXPECT_EQ(contacts[0].normal_impulse, 2);
  EXPECT_EQ(contacts[1].normal_impulse, 0);
}

TEST(ContactSolver, RubsUpToFrictionTimesThePush) {
  Vec3Field value(1);
  value.set(0, {3, -2, 4});
  std::vector<ContactConstraint> contacts{on_floor(0, 0.5)};
  solve_contacts(contacts, {1}, 10, 0, value);
  EXPECT_LE((value[0] - Vec3(3 * 0.8, 0, 4 * 0.8)).norm(), 1e-15);  // 1 of 5 is lost
}

TEST(ContactSolver, SticksWhereFrictionCouldTakeMore) {
  Vec3Field value(1);
  value.set(0, {0.3, -2, 0.4});
  std::vector<ContactConstraint> contacts{on_floor(0, 0.5)};
  contacts[0].rest = {0.1, 7, 0};
  solve_contacts(contacts, {1}, 10, 0, value);
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
  solve_contacts(contacts, inverse_mass, 10, 0, value);
  EXPECT_LE((value[0] - Vec3(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LE((value[1] - Vec3(0, -0.5, 0)).norm(), 1e-15);
}

TEST(ContactSolver, LeavesWhatCannotMove) {
  Vec3Field value(1);
  value.set(0, {0, -1, 0});
  ContactConstraint contact = on_floor(0, 0);
  contact.mobility = mobility_of(contact, {0});
  std::vector<ContactConstraint> contacts{contact};
  solve_contacts(contacts, {0}, 10, 0, value);
  EXPECT_EQ(value[0], Vec3(0, -1, 0));
}

TEST(ContactSolver, TakesAPushBackThatAnotherMadeNeedless) {
  Vec3Field value(1);
  value.set(0, {0, -1, 0});
  ContactConstraint steep = on_floor(0, 0), flat = on_floor(0, 0);
  flat.bound = 2;
  steep.normal = Vec3(1, 1, 0).normalized();
  std::vector<ContactConstraint> contacts{steep, flat};
  solve_contacts(contacts, {1}, 100, 0, value);
  EXPECT_LE((value[0] - Vec3(0, 2, 0)).norm(), 1e-12) << value[0].transpose();
  EXPECT_EQ(contacts[0].normal_impulse, 0);
}

}  // namespace
}  // namespace cloth::test::contact_solver_test
