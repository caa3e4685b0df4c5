// Products with the matrices of a mesh's bending and triangles, in every instruction set that this machine
// has, against the elements one by one.
#include "kernels/mesh_products.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/sums.h"
#include "geometry/at.h"
#include "kernels/instruction_set.h"
#include "scene/scene_cloth.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/random.h"
#include "support/states.h"

namespace cloth::test::mesh_products_test {
namespace {

/// scale K field, from s = sum c x of every element.
Vec3Field by_elements(const BendingRuns& runs, double scale, const Vec3Field& field) {
  Vec3Field product(field.size());
  for (const BendingRun& run : runs)
    for (int e = run.first; e < run.first + run.count; ++e) {
      Vec3 sum = Vec3::Zero();
      const auto points = static_cast<std::size_t>(run.points);
      for (std::size_t p = 0; p < points; ++p) sum += run.coefficient[p] * field[at(e + run.offset[p])];
      for (std::size_t p = 0; p < points; ++p)
        product.add(at(e + run.offset[p]), scale * run.stiffness * run.coefficient[p] * sum);
    }
  return product;
}

/// scale J^T K J field, from dq/dt of every edge.
Vec3Field by_triangles(const Membrane& membrane, double scale, const Vec3Field& position,
                       const Vec3Field& field) {
  Vec3Field product(field.size());
  for (const MembraneTriangle& t : membrane)
    for (std::size_t e = 0; e < 3; ++e)
      for (std::size_t f = 0; f < 3; ++f) {
        const double rate = 2 * edge_of(t, f, position).dot(edge_of(t, f, field));
        const Vec3 push = scale * t.k[e][f] * rate * 2 * edge_of(t, e, position);
        product.add(at(t.corner[e]), -push), product.add(at(t.corner[(e + 1) % 3]), push);
      }
  return product;
}

void expect_near(Vec3Field product, const Vec3Field& expected) {
  EXPECT_LE(largest_distance(product, expected), 1e-12 * largest_norm(expected));
  EXPECT_GT(largest_norm(expected), 0);
}

TEST(MeshProducts, AreThoseOfTheElementsWithTheSameBitsInEveryInstructionSet) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(0.3, 0.2, any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    const ClothState state = crumpled_state(system, 1e-3, 1, random);
    std::vector<Vec3Field> bending, membrane;
    for (const InstructionSet set : supported_instruction_sets()) {
      set_instruction_set(set);
      bending.emplace_back(state.velocity.size()), membrane.emplace_back(state.velocity.size());
      add_bending_product(system, 0.7, state.velocity, bending.back());
      add_membrane_product(system.membrane, 0.7, state.position, state.velocity, membrane.back());
      const double bending_power = bending_square(system, state.velocity),
                   membrane_power = membrane_square(system.membrane, state.position, state.velocity);
      EXPECT_NEAR(0.7 * bending_power, dot(state.velocity.flat(), bending.back().flat()),
                  1e-12 * bending_power);
      EXPECT_NEAR(0.7 * membrane_power, dot(state.velocity.flat(), membrane.back().flat()),
                  1e-12 * membrane_power);
      EXPECT_EQ(bending.back(), bending.front());
      EXPECT_EQ(membrane.back(), membrane.front());
    }
    set_instruction_set(std::nullopt);
    expect_near(bending.front(), by_elements(system.bending, 0.7, state.velocity));
    expect_near(membrane.front(), by_triangles(system.membrane, 0.7, state.position, state.velocity));
  }
}

TEST(MeshProducts, AreAddedToWhatIsThere) {
  Random random;
  const ClothSystem system = make_cloth(material_mesh_sheet(7, 9, 0.3, 0.2, 0.2, any_material(), random));
  const Vec3Field field = random.field(system.mass.size(), 1), before = random.field(system.mass.size(), 1);
  Vec3Field alone(field.size()), added = before;
  add_bending_product(system, 1, field, alone), add_bending_product(system, 1, field, added);
  add_membrane_product(system.membrane, 1, system.start, field, alone);
  add_membrane_product(system.membrane, 1, system.start, field, added);
  for (std::size_t i = 0; i < field.size(); ++i) added.add(i, -before[i]);
  EXPECT_LE(largest_distance(added, alone), 1e-12 * largest_norm(alone));
}

}  // namespace
}  // namespace cloth::test::mesh_products_test
