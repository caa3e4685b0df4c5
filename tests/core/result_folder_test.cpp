// A folder is one run or study: what was there before goes first, and what is not ours stays.
#include "io/result_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "io/text_file.h"
#include "support/files.h"

namespace cloth::test::result_folder_test {
namespace {

FolderUse use_of(const std::string& kind, std::vector<std::filesystem::path> inputs = {}) {
  return {.kind = kind, .files = {"scene.json", "record.csv", "summary.json"}, .inputs = std::move(inputs)};
}

/// As a run leaves it.
void finish_run(const std::filesystem::path& path, const std::string& more = "record-2.csv") {
  ResultFolder folder;
  ASSERT_FALSE(folder.claim(path, use_of("run")));
  for (const std::string& name : {std::string("scene.json"), std::string("record.csv"), more})
    ASSERT_FALSE(folder.write(name, "a,b\n1,2\n", true));
  ASSERT_FALSE(folder.finish("summary.json",
                             "{\"program\": \"clothlab\", \"kind\": \"run\", \"files\": {\"scene.json\": {}, "
                             "\"record.csv\": {}, \"" +
                                 more + "\": {}}}"));
}

TEST(ResultFolder, LosesTheFilesOfTheRunBeforeAndKeepsForeignOnes) {
  const TemporaryFolder folder;
  finish_run(folder.path());
  ASSERT_FALSE(write_text_file(folder / "notes.txt", "mine"));
  ResultFolder again;
  ASSERT_FALSE(again.claim(folder.path(), use_of("run")));
  for (const char* name : {"scene.json", "record.csv", "record-2.csv", "summary.json"})
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  EXPECT_EQ(content_of(folder / "notes.txt"), "mine");
}

TEST(ResultFolder, OfAKilledRunIsKnownByItsList) {
  const TemporaryFolder folder;
  {
    ResultFolder killed;
    ASSERT_FALSE(killed.claim(folder.path(), use_of("run")));
    ASSERT_FALSE(killed.write("record-7.csv", "x\n"));
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "record-7.csv"));
  finish_run(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "record-7.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / ".clothlab"))
      << "the index lists the files of a finished run";
}

TEST(ResultFolder, IsRefusedWhereAFileThatIsNotOursWouldBeReplaced) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "scene.json", "{\"mine\": 1}"));
  ResultFolder results;
  const auto error = results.claim(folder.path(), use_of("run"));
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->refused);
  EXPECT_EQ(error->path, folder / "scene.json");
  EXPECT_EQ(content_of(folder / "scene.json"), "{\"mine\": 1}");
  EXPECT_FALSE(std::filesystem::exists(folder / ".clothlab"));
}

TEST(ResultFolder, IsRefusedWhereItHoldsAnotherKind) {
  const TemporaryFolder folder;
  finish_run(folder.path());
  ResultFolder results;
  const auto error = results.claim(folder.path(), {.kind = "stability", .files = {"study.json"}});
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->refused);
  EXPECT_NE(error->text().find("holds a run"), std::string::npos) << error->text();
  EXPECT_TRUE(std::filesystem::exists(folder / "record.csv"));
}

TEST(ResultFolder, NeverReplacesAnInputBeItALink) {
  const TemporaryFolder folder;
  finish_run(folder / "results");
  std::filesystem::create_symlink(folder / "results/scene.json", folder / "link.json");
  std::filesystem::create_hard_link(folder / "results/record.csv", folder / "hard.csv");
  for (const std::string name :
       {"results/scene.json", "results/../results/record.csv", "link.json", "hard.csv"}) {
    ResultFolder results;
    const auto error = results.claim(folder / "results", use_of("run", {folder / name}));
    ASSERT_TRUE(error) << name;
    EXPECT_TRUE(error->refused);
    EXPECT_TRUE(std::filesystem::exists(folder / "results/summary.json")) << name;
  }
}

TEST(ResultFolder, HasOneWriterAtATimeAndNamesIt) {
  const TemporaryFolder folder;
  ResultFolder first, second;
  ASSERT_FALSE(first.claim(folder.path(), use_of("run")));
  ASSERT_FALSE(first.write("record.csv", "kept\n"));
  const auto error = second.claim(folder.path(), use_of("run"));
  ASSERT_TRUE(error);
  EXPECT_FALSE(error->refused);
  EXPECT_NE(error->text().find("process " + std::to_string(::getpid())), std::string::npos) << error->text();
  EXPECT_EQ(content_of(folder / "record.csv"), "kept\n");
  first.release();
  EXPECT_FALSE(second.claim(folder.path(), use_of("run")));
}

TEST(ResultFolder, DoesNotFollowALinkOutOfItself) {
  const TemporaryFolder folder;
  finish_run(folder / "results");
  ASSERT_FALSE(write_text_file(folder / "mine.csv", "mine"));
  std::filesystem::remove(folder / "results/record.csv");
  std::filesystem::create_symlink(folder / "mine.csv", folder / "results/record.csv");
  finish_run(folder / "results");
  EXPECT_EQ(content_of(folder / "mine.csv"), "mine");
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "results/record.csv"));
}

TEST(ResultFolder, RemovesNothingOutsideWhateverItsListSays) {
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "mine", "mine"));
  std::filesystem::create_directory(folder / "results");
  ASSERT_FALSE(write_text_file(folder / "results/.clothlab",
                               "clothlab folder 1\nkind run\nfile ../mine\nfile record.csv\n"));
  ASSERT_FALSE(write_text_file(folder / "results/record.csv", "old"));
  ResultFolder results;
  ASSERT_FALSE(results.claim(folder / "results", use_of("run")));
  EXPECT_EQ(content_of(folder / "mine"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "results/record.csv"));
}

TEST(ResultFolder, KnowsTheRunsOfOlderVersions) {
  const TemporaryFolder folder;
  for (const char* name : {"scene.json", "final_state.csv", "record.csv", "record-2.csv"})
    ASSERT_FALSE(write_text_file(folder / name, "old"));
  ASSERT_FALSE(
      write_text_file(folder / "summary.json", "{\"program\": \"clothlab\", \"version\": \"0.2.0\"}"));
  finish_run(folder.path(), "record-3.csv");
  EXPECT_FALSE(std::filesystem::exists(folder / "record-2.csv"));
}

TEST(FileDigests, TellRowsAndContents) {
  LineFile file;
  const TemporaryFolder folder;
  ASSERT_FALSE(file.open(folder / "t.csv"));
  for (const char* line : {"a,b", "1,2", "3,4"}) ASSERT_FALSE(file.add(line));
  ASSERT_FALSE(file.close());
  const FileDigest written = file.digest();
  EXPECT_EQ(written, digest_of("t.csv", content_of(folder / "t.csv"), true));
  EXPECT_EQ(written.rows, 2);
  EXPECT_EQ(disagreement(written, written), "");
  EXPECT_EQ(disagreement(written, digest_of("t.csv", "a,b\n1,2\n", true)), "has 1 rows, not 2");
  EXPECT_NE(disagreement(written, digest_of("t.csv", "a,b\n1,2\n3,5\n", true)), "");
}

}  // namespace
}  // namespace cloth::test::result_folder_test
