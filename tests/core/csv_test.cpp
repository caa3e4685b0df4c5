#include "io/csv.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>
#include <thread>
#include <vector>

#include "io/text_file.h"
#include "scene/builtin_scenes.h"
#include "support/files.h"
#include "support/random.h"

namespace cloth::test::csv_test {
namespace {

TEST(CsvField, IsQuotedWhereItMust) {
  EXPECT_EQ(csv_field("plain text"), "plain text");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"x\""), "\"say \"\"x\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
}

double read_number(const std::string& text) {  // strtod reads with the locale's point, so do not depend on it
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "C");
  const double value = std::strtod(text.c_str(), nullptr);
  std::setlocale(LC_NUMERIC, before.c_str());
  return value;
}

void expect_same_bits(double value) {
  const double back = read_number(csv_number(value));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value)) << csv_number(value);
}

void expect_numbers_read_back() {
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -0.0, 0.1, 1.0 / 3, Limits::min(), Limits::denorm_min(), Limits::max(),
                             Limits::lowest(), Limits::epsilon()})
    expect_same_bits(value);
  Random random;
  for (int trial = 0; trial < 10000; ++trial)
    expect_same_bits(std::ldexp(random.uniform(-1, 1), random.integer(-1000, 1000)));
}

TEST(CsvNumber, ReadsBackToTheSameBits) {
  expect_numbers_read_back();
}

/// Takes a locale with a decimal comma: an installed one, or one made for the test.
bool take_comma_locale(const TemporaryFolder& folder) {
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"})
    if (std::setlocale(LC_NUMERIC, name)) return true;
  const std::string make =
      "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "' > /dev/null 2>&1";
  if (std::system(make.c_str()) != 0) return false;
  ::setenv("LOCPATH", folder.path().c_str(), 1);
  return std::setlocale(LC_NUMERIC, "de_DE.UTF-8") != nullptr;
}

TEST(CsvNumber, ReadsBackToTheSameBitsInALocaleWithCommas) {
  const TemporaryFolder folder;
  if (!take_comma_locale(folder)) GTEST_SKIP() << "no locale with a decimal comma can be had";
  EXPECT_EQ(std::strtod("0,5", nullptr), 0.5) << "this locale has no comma";
  EXPECT_EQ(csv_number(0.5), "0.5");
  expect_numbers_read_back();
  std::setlocale(LC_NUMERIC, "C");
}

/// Of the C++ library, which has one wherever the C library has none.
struct CommaPoint : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(CsvNumber, ReadsBackToTheSameBitsWithCommasInStreams) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaPoint));
  std::ostringstream stream;
  stream << 0.5;
  EXPECT_EQ(stream.str(), "0,5");
  EXPECT_EQ(csv_number(0.5), "0.5");
  expect_numbers_read_back();
  const Scene scene = builtin_scene("wind");
  const SceneReading reading = read_scene(write_scene(scene), "name");
  std::locale::global(before);
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(*reading.scene, scene);
}

TEST(Scenes, ReadBackInALocaleWithCommas) {
  const TemporaryFolder folder;
  if (!take_comma_locale(folder)) GTEST_SKIP() << "no locale with a decimal comma can be had";
  const Scene scene = builtin_scene("wind");
  const SceneReading reading = read_scene(write_scene(scene), "name");
  std::setlocale(LC_NUMERIC, "C");
  ASSERT_TRUE(reading.scene);
  EXPECT_EQ(*reading.scene, scene);
  EXPECT_EQ(scene, builtin_scene("wind"));
}

TEST(CsvText, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const std::vector<std::string> header{"a", "b,c", "d"};
  const std::vector<std::vector<std::string>> rows{
      {"1", "2", "3"}, {"", "", "x"}, {"say \"hi\"", "two\nlines", "a,b"}, {"x", "", ""}};
  CsvFile file;
  ASSERT_FALSE(file.open(folder / "t.csv", header));
  for (const auto& row : rows) ASSERT_FALSE(file.add(row));
  ASSERT_FALSE(file.close());
  const CsvTable table = parse_csv(content_of(folder / "t.csv"));
  EXPECT_EQ(table.header, header);
  EXPECT_EQ(table.rows, rows);
}

TEST(CsvText, IsReadWithEitherLineEnd) {
  const CsvTable table = parse_csv("a,b\r\n1,2\r\n3,4");
  EXPECT_EQ(table.header, std::vector<std::string>({"a", "b"}));
  EXPECT_EQ(table.rows, std::vector<std::vector<std::string>>({{"1", "2"}, {"3", "4"}}));
  EXPECT_TRUE(parse_csv("").header.empty());
}

TEST(CsvFile, HasItsHeaderAsSoonAsItIsOpen) {
  const TemporaryFolder folder;
  CsvFile file;
  ASSERT_FALSE(file.open(folder / "t.csv", {"a", "b"}));
  EXPECT_EQ(content_of(folder / "t.csv"), "a,b\n");
}

TEST(CsvFile, HasEveryRowOnceItIsFlushed) {
  const TemporaryFolder folder;
  CsvFile file;
  ASSERT_FALSE(file.open(folder / "t.csv", {"a"}));
  ASSERT_FALSE(file.add({"1"}));
  ASSERT_FALSE(file.flush());
  EXPECT_EQ(content_of(folder / "t.csv"), "a\n1\n");
}

TEST(CsvFile, NamesTheFileThatItCouldNotOpen) {
  CsvFile file;
  const auto error = file.open("/nonexistent/t.csv", {"a"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->path, "/nonexistent/t.csv");
  EXPECT_EQ(error->text(), "/nonexistent/t.csv: No such file or directory");
}

TEST(CsvFile, OnAFullDiskGivesAnError) {
  CsvFile file;
  const auto error = file.open("/dev/full", {"a"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message, "No space left on device");
}

/// Runs `body` in a child that may write files of `bytes` at most; true if it returned true.
template <class Body>
bool in_a_child_with_file_limit(rlim_t bytes, Body body) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(body() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool add_rows_until_full(CsvFile& file) {
  for (int row = 0; row < 100; ++row)
    if (file.add({"123456789"}) || file.flush()) return true;
  return false;
}

TEST(CsvFile, TakesBackARowThatNoLongerFits) {
  const TemporaryFolder folder;
  const auto path = folder / "t.csv";
  const bool failed = in_a_child_with_file_limit(55, [&] {  // header 2, then 10 a row: 5 rows and 3 bytes
    CsvFile file;
    return !file.open(path, {"a"}) && add_rows_until_full(file);
  });
  ASSERT_TRUE(failed);
  EXPECT_EQ(content_of(path), "a\n123456789\n123456789\n123456789\n123456789\n123456789\n");
}

TEST(CsvFile, StaysValidWhenThereIsRoomAgain) {
  const TemporaryFolder folder;
  const auto path = folder / "t.csv";
  const bool failed = in_a_child_with_file_limit(25, [&] {
    CsvFile file;
    if (file.open(path, {"a"}) || !add_rows_until_full(file)) return false;
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_FSIZE, &limit);
    return !file.add({"z"}) && !file.close();
  });
  ASSERT_TRUE(failed);
  EXPECT_EQ(content_of(path), "a\n123456789\n123456789\nz\n");
}

TEST(TextFile, IsOldOrNewAndNeverHalf) {
  const TemporaryFolder folder;
  const auto path = folder / "t.txt";
  ASSERT_FALSE(write_text_file(path, "old"));
  const bool failed = in_a_child_with_file_limit(
      100, [&] { return write_text_file(path, std::string(1000, 'x')).has_value(); });
  EXPECT_TRUE(failed);
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);  // no draft is left
}

TEST(TextFile, OfManyWritersAtOnceIsWholeAndOneOfTheirs) {
  const TemporaryFolder folder;
  const auto path = folder / "t.txt";
  const auto text_of = [](int writer) { return std::string(100'000, static_cast<char>('a' + writer)); };
  std::vector<std::thread> writers;
  std::atomic<int> failures = 0;
  for (int w = 0; w < 4; ++w)
    writers.emplace_back([&, w] {
      for (int k = 0; k < 50; ++k)
        if (write_text_file(path, text_of(w))) ++failures;
    });
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failures, 0);
  const std::string left = content_of(path);
  ASSERT_FALSE(left.empty());
  EXPECT_EQ(left, text_of(left[0] - 'a'));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);  // no draft is left
}

TEST(TextFile, RemovesDraftsOfItselfAlone) {
  const TemporaryFolder folder;
  const auto path = folder / "t.csv";
  for (const auto& of : {path, path, folder / "u.csv"}) {
    const Draft draft = begin_draft(of);
    ASSERT_TRUE(write_to_disk(draft.descriptor, "half"));
    ::close(draft.descriptor);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3);
  ASSERT_FALSE(write_text_file(path, "whole"));
  ASSERT_FALSE(remove_drafts_of(path));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);  // itself, the other's
  EXPECT_EQ(content_of(path), "whole");
}

TEST(TextFile, ThatCannotBeReadSaysWhy) {
  std::string text;
  EXPECT_EQ(read_text_file("/nonexistent", text)->text(), "/nonexistent: No such file or directory");
  EXPECT_EQ(read_text_file("/tmp", text)->text(), "/tmp: is a folder");
  const TemporaryFolder folder;
  ASSERT_FALSE(write_text_file(folder / "empty", ""));
  EXPECT_FALSE(read_text_file(folder / "empty", text));
  EXPECT_EQ(text, "");
}

TEST(Folder, IsMadeWithThoseAboveItOrSaysWhyNot) {
  const TemporaryFolder folder;
  EXPECT_FALSE(make_folder(folder / "a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  ASSERT_FALSE(write_text_file(folder / "file", "x"));
  EXPECT_TRUE(make_folder(folder / "file"));
  EXPECT_TRUE(make_folder(folder / "file/below"));
}

}  // namespace
}  // namespace cloth::test::csv_test
