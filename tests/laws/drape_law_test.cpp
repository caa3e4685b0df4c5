// Cusick's drape test of materials: the rest of a round cloth on a disc, and the rows of the validation that
// have published values in place of exact ones.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "cloth/mesh_cloth.h"
#include "geometry/split_mix.h"
#include "scene/material_file.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_mesh.h"
#include "study/validation/drape_case.h"
#include "study/validation/protocols.h"
#include "study/validation/validation_report.h"
#include "support/meshes.h"

namespace cloth::test::drape_law_test {
namespace {

Material fabric(const char* name) {
  return builtin_material(name).material;
}

TEST(DrapeCase, IsAValidScene) {
  const Scene scene = drape_scene(fabric("11oz-black-denim"), 32);
  EXPECT_TRUE(find_problems(scene).empty());
  const ClothSystem system = make_cloth(scene);
  for (std::size_t i = 0; i < system.pinned.size(); ++i)
    EXPECT_EQ(system.pinned[i] != 0, system.start[i].norm() <= 0.09 + 0.4 * 0.3 / 32);
}

TEST(DrapeCase, OfDenimIsTheSameWithinTwoPointsOnThreeGrids) {
  std::vector<double> coefficients;
  for (const int cells : {24, 32, 48}) {
    const DrapeReading reading = measure_drape_of(fabric("11oz-black-denim"), cells, 1);
    EXPECT_TRUE(reading.failure.empty()) << reading.failure;
    EXPECT_TRUE(reading.is_minimum);
    EXPECT_LE(reading.rest.residual, 1e-7);
    EXPECT_GE(reading.drape.folds, 4);
    EXPECT_LE(reading.drape.folds, 8);
    coefficients.push_back(reading.drape.coefficient);
  }
  const auto [least, most] = std::minmax_element(coefficients.begin(), coefficients.end());
  EXPECT_LE(*most - *least, 0.02);
}

TEST(DrapeCase, IsFoundAgainToTheBitFromTheSameSeed) {
  const DrapeReading first = measure_drape_of(fabric("gray-interlock"), 24, 3),
                     again = measure_drape_of(fabric("gray-interlock"), 24, 3);
  EXPECT_EQ(first.rest.position, again.rest.position);
}

TEST(DrapeCase, OfAStifferClothIsALargerShadow) {
  Material limp = fabric("gray-interlock"), stiff = limp;
  stiff.bending_warp *= 4, stiff.bending_weft *= 4, stiff.twist *= 4;
  EXPECT_GT(measure_drape_of(stiff, 32, 1).drape.coefficient,
            measure_drape_of(limp, 32, 1).drape.coefficient + 0.1);
}

/// Without weight nothing falls.
TEST(DrapeCase, OfAClothThatHardlyWeighsIsFlat) {
  Material light = fabric("11oz-black-denim");
  light.areal_density = 1e-4;
  const DrapeReading reading = measure_drape_of(light, 24, 1);
  EXPECT_NEAR(reading.drape.coefficient, 1, 2e-3);
  EXPECT_EQ(reading.drape.folds, 0);
}

TEST(DrapeCase, SaysWhereTheGridLocks) {
  EXPECT_GT(measure_drape_of(fabric("polyester-faille"), 24, 1).locking.cells_above, 0.1);
  EXPECT_LT(measure_drape_of(fabric("11oz-black-denim"), 32, 1).locking.cells_above, 0.01);
}

/// The specimen of triangles that are all alike, `cells` across, pinned as far beyond the disc as a grid.
Scene specimen_of_triangles(const Material& material, int cells) {
  const double a = 2 * specimen_radius / cells, h = a * std::sqrt(3.0) / 2;
  TriangleMesh surface;
  std::map<std::pair<int, int>, int> number;
  const auto place = [&](int i, int j) { return Vec3(a * (i + 0.5 * j), 0, h * j); };
  const auto has = [&](int i, int j) { return place(i, j).norm() <= specimen_radius; };
  const auto vertex = [&](int i, int j) {
    const auto [known, is_new] = number.emplace(std::pair(i, j), static_cast<int>(number.size()));
    if (is_new) surface.vertices.push_back(place(i, j));
    return known->second;
  };
  for (int j = -2 * cells; j < 2 * cells; ++j)
    for (int i = -2 * cells; i < 2 * cells; ++i) {
      if (!has(i + 1, j) || !has(i, j + 1)) continue;
      if (has(i, j)) surface.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)});
      if (has(i + 1, j + 1))
        surface.triangles.push_back({vertex(i + 1, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
    }
  Scene scene;
  scene.cloth = {.mesh = made_mesh("made.obj", surface),
                 .columns = static_cast<int>(surface.vertices.size()),
                 .rows = 1,
                 .origin = Vec3::Zero(),
                 .down = {0, 0, 1},
                 .pins = {}};
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    if (surface.vertices[i].norm() <= drape_disc_radius + 0.4 * a)
      scene.cloth.pins.emplace_back(PinnedParticle{0, static_cast<int>(i)});
  scene.material = material;
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

double drape_of_triangles(const Material& material, int cells, std::uint64_t seed) {
  const Scene scene = specimen_of_triangles(material, cells);
  const ClothSystem system = make_cloth(scene);
  Vec3Field position = system.start;
  SplitMix random(seed);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double height = 0.002 * random.number();
    if (!system.pinned[i]) position.add(i, {0, height, 0});
  }
  const RestShape rest = find_rest(scene, system, position, {.tolerance = 1e-7, .iterations = 2000});
  EXPECT_TRUE(rest.found) << rest.failure;
  return measure_drape(triangles_of(system), system.start, rest.position, {.radius = drape_disc_radius})
      .coefficient;
}

TEST(DrapeCase, IsWithinTwoPointsOnAMeshOfTriangles) {
  const Material denim = fabric("11oz-black-denim");
  const double grid = measure_drape_of(denim, 64, 1).drape.coefficient;
  const double mesh = (drape_of_triangles(denim, 64, 1) + drape_of_triangles(denim, 64, 2)) / 2;
  std::printf("grid %.1f %%, mesh %.1f %%\n", 100 * grid, 100 * mesh);
  EXPECT_NEAR(mesh, grid, 0.02);
}

TEST(DrapeCase, OfCottonHasHalfTheFoldsAndStandsOffFurtherWithItsHysteresis) {
  Material elastic = fabric("cotton-broad");
  elastic.hysteresis_warp = elastic.hysteresis_weft = 0;
  const DrapeReading without = measure_drape_of(elastic, 64, 1),
                     with = measure_drape_of(fabric("cotton-broad"), 64, 1);
  EXPECT_EQ(without.failure + with.failure, "");
  std::printf("elastic %.1f %%, %d folds; with hysteresis %.1f %%, %d folds\n",
              100 * without.drape.coefficient, without.drape.folds, 100 * with.drape.coefficient,
              with.drape.folds);
  EXPECT_GT(with.drape.coefficient, without.drape.coefficient + 0.04);
  EXPECT_LE(with.drape.folds, 5);
  EXPECT_GE(without.drape.folds, 7);
}

TEST(DrapeRows, AreOfEveryPresetThatSpringsOnSquareCellsCanBe) {
  const std::vector<ValidationRow> rows = validation_rows({"drape"});
  constexpr std::size_t with_hysteresis = 3;  // twice: as they are, and elastic
  EXPECT_EQ(rows.size(), builtin_materials().size() - 1 + with_hysteresis);
  for (const ValidationRow& row : rows) {
    EXPECT_NE(row.parameter_text, "navy-sparkle-sweat");
    EXPECT_TRUE(row.is_measured);
    EXPECT_EQ(name_of(row), "drape-" + row.parameter_text);
  }
  EXPECT_FALSE(find_problems(drape_scene(fabric("navy-sparkle-sweat"), 32)).empty());
}

TEST(DrapeRows, SayWhetherTheFinestGridIsWithinWhatWasPublished) {
  ValidationRow row{.protocol = "drape",
                    .parameter_name = "material",
                    .parameter_text = "11oz-black-denim",
                    .band = ValueBand{0.7, 0.9},
                    .is_measured = true,
                    .promise = Promise::none};
  for (const auto& [cells, value] : {std::pair{32, 0.95}, {64, 0.85}, {128, 0.825}})
    row.grids.push_back({.cells = cells, .value = value, .seconds = 1.5, .drape = DrapeFacts{.folds = 5}});
  EXPECT_NEAR(row.order(), 2, 1e-9);
  EXPECT_TRUE(row.holds());
  const std::string text = validation_text({row});
  for (const char* part : {"11oz-black-denim", "70 to 90 %", "95.0 %", "82.5 %", "2.00", "4.5 s", "within"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const std::string csv =
      csv_text(table_of(ValidationStudy{.protocols = {}, .expected = {}, .rows = {row}}), "\n");
  for (const char* part :
       {"drape,material,11oz-black-denim,,,,,0.69999999999999996,0.90000000000000002,32,0.9", ",64,0.84",
        ",5,0,0,\n"})
    EXPECT_NE(csv.find(part), std::string::npos) << part << csv;
  row.band = ValueBand{0.283, 0.283};
  EXPECT_NE(validation_text({row}).find("54.2 points above"), std::string::npos);
  row.grids[1].value = 0.99;
  EXPECT_FALSE(std::isfinite(row.order())) << "what does not converge has no order";
}

}  // namespace
}  // namespace cloth::test::drape_law_test
