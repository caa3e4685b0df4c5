// Materials against exact solutions as a study: its folder, what is left of it when it was stopped, its
// diagrams.
#include <gtest/gtest.h>

#include <cmath>

#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "study/validation/validation_report.h"
#include "support/files.h"

namespace cloth::test::validation_study_test {
namespace {

const ValidationOptions few{.protocols = {"catenary", "self-buckling", "picture-frame"}};

/// Stopped after so many rows, with the folder as it is then.
ValidationStudy stopped_after(std::size_t rows, const std::filesystem::path& folder) {
  StudyRecorder recorder;
  EXPECT_FALSE(recorder.begin(folder, plan_validation(few), {.command = "the command"}));
  ValidationOptions options = few;
  std::size_t made = 0;
  options.partial = [&](const ValidationStudy& so_far) {
    made = so_far.rows.size();
    EXPECT_FALSE(recorder.keep(so_far));
  };
  options.stop = [&] { return made >= rows; };
  return run_validation(options);
}

TEST(ValidationStudy, ComesBackFromItsFolderAsItWasWritten) {
  const ValidationStudy study = run_validation(few);
  const TemporaryFolder folder;
  ASSERT_FALSE(StudyRecorder::write(folder.path(), study, "the command", 1));
  const StudyReading reading = read_study(folder.path());
  ASSERT_TRUE(reading.study) << reading.problem;
  const auto& back = std::get<ValidationStudy>(reading.study->table);
  EXPECT_TRUE(back.is_complete());
  EXPECT_EQ(study_csv(back), study_csv(study));
  EXPECT_EQ(study_json(back), study_json(study));
  EXPECT_EQ(points_table(back).rows, points_table(study).rows);
  EXPECT_EQ(points_table(back).rows.size(), 3 * 21u);
  for (std::size_t k = 0; k < diagram_names(study).size(); ++k)
    EXPECT_EQ(to_svg(study_plot(back, k)), to_svg(study_plot(study, k))) << diagram_names(study)[k];
}

TEST(ValidationStudy, GoesOnWhereItWasKilled) {
  const TemporaryFolder folder;
  const ValidationStudy first = stopped_after(2, folder.path());
  ASSERT_EQ(first.rows.size(), 2u);
  StudyRecorder recorder;
  ASSERT_FALSE(recorder.begin(folder.path(), plan_validation(few), {.command = "the command"}));
  ASSERT_TRUE(recorder.earlier());
  ValidationOptions options = few;
  options.earlier = &std::get<ValidationStudy>(*recorder.earlier());
  ASSERT_EQ(options.earlier->rows.size(), 2u);
  std::size_t told = 0;
  options.partial = [&](const ValidationStudy& so_far) {
    ++told;
    EXPECT_FALSE(recorder.keep(so_far));
  };
  const ValidationStudy whole = run_validation(options);
  ASSERT_FALSE(recorder.end(whole, 1));
  EXPECT_EQ(told, whole.rows.size() - 2) << "what was there is not measured again";
  EXPECT_EQ(study_csv(whole), study_csv(run_validation(few)));
  EXPECT_EQ(study_csv(read_study(folder.path()).study->table), study_csv(whole));
}

TEST(ValidationStudy, IsNotReadWhereItsTableIsAnotherOne) {
  const TemporaryFolder folder;
  ASSERT_FALSE(
      StudyRecorder::write(folder.path(), run_validation({.protocols = {"astm-d1388"}}), "the command", 1));
  std::string text;
  ASSERT_FALSE(read_text_file(folder / "study.json", text));
  text.replace(text.rfind("\"astm-d1388\""), 12, "\"astm-d1389\"");
  ASSERT_FALSE(write_text_file(folder / "study.json", text));
  const StudyReading reading = read_study(folder.path());
  EXPECT_FALSE(reading.study);
  EXPECT_NE(reading.problem.find("is not a protocol"), std::string::npos) << reading.problem;
}

TEST(ValidationStudy, OpensACantileverAsAStripAndNothingThatStartsBent) {
  const ValidationStudy study = plan_validation({.protocols = {"cantilever", "heart-loop", "swing"}});
  for (const ValidationRow& row : study.expected)
    EXPECT_EQ(scene_of(row).has_value(), row.protocol == "cantilever") << name_of(row);
  ValidationStudy made{study.protocols, study.expected, {study.expected.front()}};
  const auto run = run_of(made, 0);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->scene.cloth.columns, 22) << "20 cells and one behind the clamp";
  EXPECT_FALSE(run_of(made, 1));
}

}  // namespace
}  // namespace cloth::test::validation_study_test
