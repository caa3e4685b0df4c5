// A scene on another grid is the same sheet, held at the same places, or there is none.
#include "study/refined_scene.h"

#include <gtest/gtest.h>

#include <set>

#include "scene/builtin_scenes.h"
#include "scene/scene_checks.h"

namespace cloth::test::refined_scene_test {
namespace {

/// 8 x 4 cells with these pins.
Scene pinned(std::vector<Pin> pins) {
  Scene scene = builtin_scene("corners-free");
  scene.cloth.columns = 9, scene.cloth.rows = 5;
  scene.cloth.pins = std::move(pins);
  return scene;
}

std::vector<Pin> block(int first_row, int last_row, int first_column, int last_column) {
  std::vector<Pin> pins;
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column)
      pins.emplace_back(PinnedParticle{row, column});
  return pins;
}

/// Where particles are pinned, in parts of the sheet.
std::set<std::pair<double, double>> places(const Scene& scene) {
  std::set<std::pair<double, double>> found;
  for (const int particle : pinned_particles(scene.cloth))
    found.insert({static_cast<double>(particle / scene.cloth.columns) / (scene.cloth.rows - 1),
                  static_cast<double>(particle % scene.cloth.columns) / (scene.cloth.columns - 1)});
  return found;
}

TEST(RefinedScene, IsTheSameSheetInTheSceneProportion) {
  const Scene scene = pinned({NamedPin::top_left, NamedPin::right_edge});
  for (const int cells : {2, 8, 16, 30}) {
    const Scene refined = refined_scene(scene, cells);
    EXPECT_EQ(refined.cloth.columns, cells + 1);
    EXPECT_EQ(refined.cloth.rows, cells / 2 + 1);
    EXPECT_TRUE(find_problems(refined).empty());
    Scene back = refined;
    back.cloth.columns = 9, back.cloth.rows = 5;
    EXPECT_TRUE(back == scene) << "nothing else changes";
  }
  EXPECT_EQ(cell_unit(scene), 2);
}

TEST(RefinedScene, WithItsOwnCellsIsTheSceneItself) {
  const Scene scene = pinned(block(0, 4, 0, 1));
  EXPECT_TRUE(refined_scene(scene, 8) == scene);
}

TEST(RefinedScene, HoldsSingleParticlesWhereTheyWere) {
  const Scene scene = pinned({PinnedParticle{0, 0}, PinnedParticle{0, 4}, PinnedParticle{2, 6}});
  EXPECT_EQ(cell_unit(scene), 4);
  for (const int cells : {4, 8, 12, 40}) EXPECT_EQ(places(refined_scene(scene, cells)), places(scene));
}

TEST(RefinedScene, FillsARectangleOfPins) {
  const Scene clamp = pinned(block(0, 4, 0, 2));
  EXPECT_EQ(cell_unit(clamp), 4);
  const Scene fine = refined_scene(clamp, 32);
  EXPECT_EQ(pinned_particles(fine.cloth).size(), 17u * 9u);
  for (const auto& [down, across] : places(fine)) EXPECT_LE(across, 0.25) << down;
  const Scene mixed = pinned([] {
    std::vector<Pin> pins = block(0, 4, 1, 2);
    pins.emplace_back(NamedPin::left_edge);
    return pins;
  }());
  EXPECT_EQ(places(refined_scene(mixed, 32)), places(fine)) << "an edge and the columns beside it are one";
}

TEST(RefinedScene, FillsEdgesThatWereGivenByTheirParticles) {
  std::vector<Pin> frame = block(0, 0, 0, 8);
  for (const Pin& pin : block(0, 4, 0, 0)) frame.push_back(pin);
  const Scene scene = pinned(frame);
  EXPECT_FALSE(refinement_problem(scene));
  EXPECT_EQ(places(refined_scene(scene, 24)),
            places(refined_scene(pinned({NamedPin::top_edge, NamedPin::left_edge}), 24)));
}

TEST(RefinedScene, IsRefusedWhereItsPinsMeanAnotherPlaceOnAnotherGrid) {
  for (const std::vector<Pin>& pins :
       {std::vector<Pin>{PinnedParticle{0, 0}, PinnedParticle{0, 1}, PinnedParticle{1, 1}},
        std::vector<Pin>{NamedPin::top_edge, PinnedParticle{1, 3}}}) {
    const auto problem = refinement_problem(pinned(pins));
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->path, "cloth.pins");
    EXPECT_NE(problem->rule.find("no rectangle"), std::string::npos) << problem->rule;
  }
  const auto mesh = refinement_problem(builtin_scene("disc"));
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->path, "cloth.mesh");
}

TEST(Grids, AreMultiplesOfTheUnitFromCoarseToFine) {
  const Scene scene = pinned({PinnedParticle{0, 1}});
  EXPECT_EQ(cell_unit(scene), 8);
  EXPECT_FALSE(broken_cells_rule(scene, {8, 16, 24}));
  for (const auto& [cells, rule] :
       {std::pair{std::vector<int>{8, 12}, "12: must be a multiple of 8"},
        {std::vector<int>{16, 8}, "8: must be more than 16"},
        {std::vector<int>{8, 8}, "8: must be more than 8"},
        {std::vector<int>{-8, 8}, "-8: must be a multiple of 8"},
        {std::vector<int>{8, 8000}, "8000: a grid has at most 4096 rows and columns"},
        {std::vector<int>{8}, "must be two grids or more"}}) {
    const auto broken = broken_cells_rule(scene, cells);
    ASSERT_TRUE(broken) << rule;
    EXPECT_NE(broken->find(rule), std::string::npos) << *broken;
  }
  EXPECT_EQ(broken_cells_rule(pinned({}), {0, 2}).value().substr(0, 20), "0: must be a multipl");
}

TEST(Grids, OfEveryBuiltInSceneHaveDefaultsThatKeepTheRules) {
  for (const BuiltinScene& known : builtin_scenes()) {
    const std::string& name = known.name;
    const Scene scene = builtin_scene(name);
    if (refinement_problem(scene)) continue;
    const std::vector<int> cells = default_cells(scene);
    EXPECT_GE(cells.size(), 3u) << name;
    EXPECT_FALSE(broken_cells_rule(scene, cells)) << name;
    EXPECT_TRUE(find_problems(refined_scene(scene, cells.front())).empty()) << name;
  }
}

}  // namespace
}  // namespace cloth::test::refined_scene_test
