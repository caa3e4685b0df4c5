// Cusick's drape test of materials: the rest of a round cloth on a disc, and the rows of the validation that
// have published values in place of exact ones.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/material_file.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "study/validation/drape_case.h"
#include "study/validation/protocols.h"
#include "study/validation/validation_report.h"

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

TEST(DrapeRows, AreOfEveryPresetThatSpringsOnSquareCellsCanBe) {
  const std::vector<ValidationRow> rows = validation_rows({"drape"});
  EXPECT_EQ(rows.size(), builtin_materials().size() - 1);
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
  const std::string csv = validation_csv({row});
  for (const char* part : {"drape,material,11oz-black-denim,,,,,32,0.9",
                           "drape,material,11oz-black-denim,,,,,64,0.8", ",5,0,0,1.5\r\n"})
    EXPECT_NE(csv.find(part), std::string::npos) << part << csv;
  row.band = ValueBand{0.283, 0.283};
  EXPECT_NE(validation_text({row}).find("54.2 points above"), std::string::npos);
  row.grids[1].value = 0.99;
  EXPECT_FALSE(std::isfinite(row.order())) << "what does not converge has no order";
}

}  // namespace
}  // namespace cloth::test::drape_law_test
