// What may reach a terminal.
#include "io/printable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/random.h"

namespace cloth::test::printable_test {
namespace {

TEST(Printable, LeavesTextOfEveryLanguageAsItIs) {
  for (const char* text : {"", "plain", "Größe 3 µm", "布", "ткань", "نسيج", "𝑥 → 🧵", "a\\n"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesControlCharactersAndWhatTurnsTheDirectionOfWriting) {
  EXPECT_EQ(printable("\x1b[31mred\x07"), "\\u001b[31mred\\u0007");
  EXPECT_EQ(printable("two\nlines\r\t"), "two\\u000alines\\u000d\\u0009");
  EXPECT_EQ(printable("\x7f\xc2\x9b"), "\\u007f\\u009b");
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\u202e");
  EXPECT_EQ(printable(std::string(1, '\0')), "\\u0000");
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("a\xff" "b"), "a\\xffb");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "a slash in two bytes";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair of UTF-16";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
  EXPECT_EQ(printable("\xe5\xb8"), "\\xe5\\xb8") << "cut off";
}

TEST(PrintableLines, KeepsLinesAndNothingElse) {
  EXPECT_EQ(printable_lines("a\nb\r\nc\rd\x1b"), "a\nb\r\nc\\u000dd\\u001b");
}

TEST(PrintableLines, LeavesJsonItsMeaning) {
  const nlohmann::json value{{"title", "\x7f \xc2\x9b \xe2\x80\xae \x1b \n Größe"}, {"n", {1, 2}}};
  const std::string text = printable_lines(value.dump(2));
  EXPECT_EQ(nlohmann::json::parse(text), value);
  EXPECT_EQ(text.find('\x7f'), std::string::npos);
}

TEST(Printable, OfAnyBytesHasNoControlCharacterAndIsUtf8) {
  Random random;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string text;
    for (int k = 0; k < 40; ++k) text += static_cast<char>(random.integer(0, 255));
    const std::string shown = printable(text);
    ASSERT_TRUE(is_utf8(shown));
    for (const char c : shown) ASSERT_FALSE(c >= 0 && (c < 32 || c == 127)) << shown;
    ASSERT_EQ(shown.find("\xc2\x80"), std::string::npos);
  }
}

}  // namespace
}  // namespace cloth::test::printable_test
