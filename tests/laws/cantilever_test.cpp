// Strips of a material that are clamped at one end and bend under their own weight, against the exact curve.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "exact/heavy_strip.h"
#include "scene/scene_cloth.h"
#include "simulation/rest_shape.h"
#include "study/richardson.h"
#include "support/material_meshes.h"
#include "support/scenes.h"

namespace cloth::test::cantilever_test {
namespace {

constexpr double g = 9.81, density = 0.2, length = 0.1;  // m/s^2, kg/m^2, m of the overhang

/// A strip of so many cells along its overhang, which lies flat and is clamped by two columns of pins. Along
/// the rows, or along the columns.
Scene strip(double bending, int cells, bool along_rows = true) {
  const double a = length / cells;
  constexpr int across = 3;
  Scene scene = bare_sheet(across, cells + 2);
  ClothSheet& cloth = scene.cloth;
  cloth.origin = Vec3(-a, 0, 0);
  cloth.width = a * (cells + 1), cloth.height = a * (across - 1);
  cloth.across = Vec3(1, 0, 0), cloth.down = Vec3(0, 0, 1);
  for (int row = 0; row < across; ++row)
    for (int column = 0; column < 2; ++column)
      cloth.pins.emplace_back(along_rows ? PinnedParticle{row, column} : PinnedParticle{column, row});
  if (!along_rows) {
    std::swap(cloth.rows, cloth.columns), std::swap(cloth.width, cloth.height);
    std::swap(cloth.across, cloth.down);
  }
  scene.gravity = Vec3(0, -g, 0);
  const double stiff = 1e6 * bending / (length * length);
  scene.material = Material{.areal_density = density,
                            .stretch_warp = stiff,
                            .stretch_weft = stiff,
                            .shear = stiff / 10,
                            .bending_warp = bending,
                            .bending_weft = bending,
                            .twist = bending};
  return scene;
}

double bending_at_load(double gamma) {
  return density * g * std::pow(length, 3) / gamma;
}

/// H/W of the free end's middle at rest.
double droop_over_width(const Scene& scene, bool along_rows = true) {
  const RestShape rest = find_rest(scene);
  EXPECT_TRUE(rest.found) << rest.failure;
  const ClothSheet& cloth = scene.cloth;
  const int tip = along_rows ? 1 * cloth.columns + cloth.columns - 1 : (cloth.rows - 1) * cloth.columns + 1;
  const Vec3 at = rest.position[static_cast<std::size_t>(tip)];
  return -at.y() / at.x();
}

TEST(HeavyStrip, DroopsAsTheExactCurveSaysAtTwentyCellsForEveryLoadUpToTwenty) {
  for (const double gamma : {0.1, 1.0, 2.0, 5.0, 8.0, 10.0, 20.0}) {
    const double exact = exact::heavy_cantilever(gamma).droop_over_width;
    const double found = droop_over_width(strip(bending_at_load(gamma), 20));
    EXPECT_NEAR(found, exact, 0.01 * exact) << gamma;
    RecordProperty("error at Gamma " + std::to_string(gamma), std::to_string(found / exact - 1));
  }
}

TEST(HeavyStrip, IsTheSameAlongTheWarpAndTheWeft) {
  const Scene weft = strip(bending_at_load(5), 12), warp = strip(bending_at_load(5), 12, false);
  EXPECT_NEAR(droop_over_width(weft), droop_over_width(warp, false), 1e-7);
}

TEST(HeavyStrip, ConvergesWithTheSquareOfTheCellsOverFourGrids) {
  for (const double gamma : {1.0, 5.0, 20.0, 50.0}) {
    const double exact = exact::heavy_cantilever(gamma).droop_over_width;
    double before = 0;
    for (const int cells : {10, 20, 40, 80}) {
      const double error = droop_over_width(strip(bending_at_load(gamma), cells)) - exact;
      if (before != 0) {
        EXPECT_GE(std::log2(before / error), 1.8) << gamma << ", " << cells << " cells";
        EXPECT_LE(std::log2(before / error), 2.2) << gamma << ", " << cells << " cells";
      }
      before = error;
    }
  }
}

TEST(HeavyStrip, HangsEverLowerUnderLoadsUpToAThousand) {
  for (const double gamma : {100.0, 1000.0}) {
    const double exact = exact::heavy_cantilever(gamma).droop_over_width;
    EXPECT_NEAR(droop_over_width(strip(bending_at_load(gamma), 80)), exact, 0.03 * exact) << gamma;
  }
}

TEST(HeavyStrip, OfOneMaterialDroopsAlikeOnEveryGridFromTwentyCellsOn) {
  const double bending = bending_at_load(8);
  const double finest = droop_over_width(strip(bending, 80));
  for (const int cells : {20, 28, 40, 57})
    EXPECT_NEAR(droop_over_width(strip(bending, cells)), finest, 0.01 * finest) << cells;
}

TEST(HeavyStrip, DroopsInProportionToASmallLoad) {
  const double less = droop_over_width(strip(bending_at_load(0.02), 20)),
               more = droop_over_width(strip(bending_at_load(0.2), 20));
  EXPECT_NEAR(std::log(more / less) / std::log(10), 1, 0.02);
}

/// The same strip of triangles, `across` cells wide; two columns of vertices are pinned.
Scene strip_of_triangles(double bending, int cells, double disorder, Random& random) {
  constexpr int across = 4;
  const double a = length / cells;
  Scene scene = material_mesh_sheet(cells + 2, across + 1, a * (cells + 1), a * across, disorder,
                                    *strip(bending, cells).material, random, 2);
  scene.cloth.origin = Vec3(-a, 0, 0);
  for (int row = 0; row <= across; ++row)
    for (int column = 0; column < 2; ++column)
      scene.cloth.pins.emplace_back(PinnedParticle{0, row * (cells + 2) + column});
  scene.gravity = Vec3(0, 0, -g);
  return scene;
}

double droop_over_width_of_triangles(const Scene& scene, int cells) {
  const RestShape rest = find_rest(scene);
  EXPECT_TRUE(rest.found) << rest.failure;
  const Vec3 at = rest.position[static_cast<std::size_t>(2 * (cells + 2) + cells + 1)];
  return -at.z() / at.x();
}

/// The error in H/W, within 1 % at 20 cells, and its order.
void expect_second_order_of_triangles(double gamma, double disorder, double least, double most,
                                      Random& random) {
  const double exact = exact::heavy_cantilever(gamma).droop_over_width;
  double before = 0;
  for (const int cells : {10, 20, 40}) {
    const Scene scene = strip_of_triangles(bending_at_load(gamma), cells, disorder, random);
    const double error = droop_over_width_of_triangles(scene, cells) - exact;
    if (cells == 20) {
      EXPECT_LE(std::abs(error), 0.01 * exact) << gamma;
    }
    if (before != 0) {
      EXPECT_GE(std::log2(before / error), least) << gamma << ", " << cells << " cells";
      EXPECT_LE(std::log2(before / error), most) << gamma << ", " << cells << " cells";
    }
    before = error;
  }
}

TEST(HeavyStripOfTriangles, ConvergesWithTheSquareOfTheCellsOnARegularMesh) {
  Random random;
  for (const double gamma : {1.0, 5.0, 20.0}) expect_second_order_of_triangles(gamma, 0, 1.8, 2.2, random);
}

/// No two meshes are alike but in what they converge with.
TEST(HeavyStripOfTriangles, ConvergesAsFastWithRandomDiagonalsAndMovedVertices) {
  Random random;
  for (const double gamma : {1.0, 20.0}) expect_second_order_of_triangles(gamma, 0.2, 1.5, 3, random);
}

}  // namespace
}  // namespace cloth::test::cantilever_test
