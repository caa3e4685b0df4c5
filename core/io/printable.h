// Text from files and arguments on its way to a terminal, where a control character is a command: it could
// move the cursor, change what was printed before, or rename the window.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cloth {

/// One character of a text. `length` bytes; `code` is negative where they are no UTF-8.
struct Utf8Character {
  std::int32_t code = -1;
  std::size_t length = 1;
};

/// Of `text`, which is not empty. Refuses what is longer than it need be, surrogates, and codes beyond
/// U+10FFFF.
Utf8Character first_character(std::string_view text);

/// One line: control characters (line ends included) and marks that turn the direction of writing as \u001b,
/// bytes that are no UTF-8 as \xff; all else as it is.
std::string printable(std::string_view text);

/// The same for a text of several lines, which stay lines. JSON keeps its meaning: such characters stand
/// within its strings, where \u009b reads back as the character.
std::string printable_lines(std::string_view text);

/// Whether all of it is well-formed UTF-8 (Unicode 15, table 3-7).
bool is_utf8(std::string_view text);

}  // namespace cloth
