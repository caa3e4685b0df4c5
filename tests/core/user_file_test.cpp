// A file that somebody named, wherever it lies.
#include "io/user_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/files.h"

namespace cloth::test::user_file_test {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& file) {
  struct stat facts {};
  EXPECT_EQ(::stat(file.c_str(), &facts), 0);
  return facts.st_mode & 07777;
}

void put(const fs::path& file, const std::string& text) {
  ASSERT_FALSE(write_user_file(file, text));
}

TEST(UserFile, IsWrittenThroughLinksWhichStayLinks) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "far");
  put(folder / "far/target", "old");
  fs::create_symlink("far/target", folder / "near");
  fs::create_symlink("near", folder / "nearer");
  fs::create_symlink("far/none yet", folder / "dangling");
  put(folder / "nearer", "new");
  put(folder / "dangling", "made");
  EXPECT_TRUE(fs::is_symlink(folder / "near") && fs::is_symlink(folder / "nearer") &&
              fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(content_of(folder / "far/target"), "new");
  EXPECT_EQ(content_of(folder / "far/none yet"), "made");
}

TEST(UserFile, KeepsItsMode) {
  const TemporaryFolder folder;
  for (const mode_t mode : {0600, 0640, 0755, 0666}) {
    put(folder / "file", "old");
    ASSERT_EQ(::chmod((folder / "file").c_str(), mode), 0);
    put(folder / "file", "new");
    EXPECT_EQ(mode_of(folder / "file"), mode);
    EXPECT_EQ(content_of(folder / "file"), "new");
  }
}

TEST(UserFile, ShowsItsNewContentUnderItsOtherNames) {
  const TemporaryFolder folder;
  put(folder / "one", "a long old text");
  fs::create_hard_link(folder / "one", folder / "two");
  put(folder / "one", "new");
  EXPECT_EQ(content_of(folder / "two"), "new");
  EXPECT_EQ(fs::hard_link_count(folder / "one"), 2U);
}

TEST(UserFile, IsNoDeviceNoPipeNoFolderAndNoCircleOfLinks) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  fs::create_symlink("/dev/null", folder / "null");
  for (const fs::path& path : {fs::path("/dev/null"), folder / "null", folder / "pipe", folder.path(),
                               folder / "a", folder / "none/file", folder / "a/file"}) {
    const auto seen = problem_of_user_file(path), met = write_user_file(path, "text");
    ASSERT_TRUE(seen) << path;
    ASSERT_TRUE(met) << path;
    EXPECT_EQ(seen->text(), met->text());
  }
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_EQ(write_user_file("/dev/null", "")->message, "is a device: the result goes into a file");
}

TEST(UserFile, LeavesNothingBesideIt) {
  const TemporaryFolder folder;
  put(folder / "file", "a");
  put(folder / "file", "b");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace cloth::test::user_file_test
