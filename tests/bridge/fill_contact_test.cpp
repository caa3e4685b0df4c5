
#include <gtest/gtest.h>

#include "bridge/fill_frame.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "support/count_allocations.h"

namespace clothlab::fill_contact_test {
namespace {

void run_to_contact(cloth::Simulation& simulation) {
  while (simulation.last_contact().contacts == 0) ASSERT_FALSE(simulation.step());
}

TEST(FillContact, TellsNothingThatIsNotAskedFor) {
  cloth::Simulation simulation(cloth::builtin_scene("fold"));
  run_to_contact(simulation);
  ClothFrame frame;
  ContactFiller filler;
  filler.fill(simulation, {.marks = true, .box_level = 2}, frame);
  ASSERT_FALSE(frame.contact.marks.empty());
  ASSERT_FALSE(frame.contact.boxes.empty());
  filler.fill(simulation, {}, frame);
  EXPECT_FALSE(frame.contact.has_marks);
  EXPECT_TRUE(frame.contact.marks.empty());
  EXPECT_TRUE(frame.contact.boxes.empty());
  EXPECT_TRUE(frame.contact.groups.empty());
  EXPECT_GT(frame.contact.depth, 0) << "but that there is a hierarchy";
}

TEST(FillContact, PushesAreSharesOfTheStrongest) {
  cloth::Simulation simulation(cloth::builtin_scene("fold"));
  run_to_contact(simulation);
  ClothFrame frame;
  ContactFiller().fill(simulation, {.marks = true}, frame);
  const auto& marks = frame.contact.marks;
  ASSERT_EQ(marks.size() % 7, 0U);
  float strongest = 0;
  for (std::size_t k = 6; k < marks.size(); k += 7) {
    EXPECT_GT(marks[k], 0);
    strongest = std::max(strongest, marks[k]);
  }
  EXPECT_EQ(strongest, 1);
}

TEST(FillContact, EveryLevelOfTheHierarchyHoldsTheWholeCloth) {
  cloth::Simulation simulation(cloth::builtin_scene("fold"));
  run_to_contact(simulation);
  ContactFiller filler;
  ClothFrame frame;
  std::size_t before = 0;
  for (int level = 0; level <= simulation.hierarchy_depth(-1); ++level) {
    filler.fill(simulation, {.box_level = level}, frame);
    const auto& boxes = frame.contact.boxes;
    ASSERT_EQ(frame.contact.groups.size(), 1U);
    EXPECT_EQ(boxes.size(), 6 * static_cast<std::size_t>(frame.contact.groups[0].count));
    EXPECT_GT(boxes.size(), before);
    before = boxes.size();
    const cloth::Vec3Field& position = simulation.state().position;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Eigen::Vector3f p = position[i].cast<float>();
      bool held = false;
      for (std::size_t b = 0; b < boxes.size(); b += 6) {
        const Eigen::Map<const Eigen::Array3f> lower(&boxes[b]), upper(&boxes[b + 3]);
        held = held || ((lower <= p.array()).all() && (p.array() <= upper).all());
      }
      ASSERT_TRUE(held) << "particle " << i << " at level " << level;
    }
  }
  filler.fill(simulation, {.box_level = 99}, frame);
  EXPECT_EQ(frame.contact.boxes.size(), before) << "deeper than the deepest is the deepest";
}

TEST(FillContact, TheBoxesOfAMeshAreInItsOwnCoordinates) {
  cloth::Simulation simulation(cloth::builtin_scene("spikes"));
  ClothFrame frame;
  ContactFiller().fill(simulation, {.box_level = 1}, frame);
  ASSERT_FALSE(frame.contact.groups.empty());
  EXPECT_EQ(simulation.scene().obstacles[static_cast<std::size_t>(frame.contact.groups[0].obstacle)].shape,
            &cloth::mesh_shape());
}

TEST(FillContact, AllocatesNothingOnceItHasBeenAsMuch) {
  cloth::Simulation simulation(cloth::builtin_scene("fold"));
  run_to_contact(simulation);
  ContactFiller filler;
  ClothFrame frame;
  cloth::Vec3Field scratch;
  const auto fill = [&] {
    fill_frame(simulation, simulation.state(), scratch, frame);
    filler.fill(simulation, {.marks = true, .box_level = 3}, frame);
  };
  for (int warm_up = 0; warm_up < 2; ++warm_up) fill();
  EXPECT_EQ(test::allocations_of(fill).calls, 0);
}

}  // namespace
}  // namespace clothlab::fill_contact_test
