#include "io/json_syntax.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "io/json_locator.h"

namespace cloth {
namespace {

using json = nlohmann::json;

/// Only notes where and why a text is not JSON, or is nested so deeply or has so many values that it cannot
/// be a file of this program. Reads without recursion, and without keeping what it reads.
struct SyntaxCheck : nlohmann::json_sax<json> {
  static constexpr int deepest = 64;
  static constexpr std::size_t max_values = 10'000'000;
  const std::size_t length;  // of the text
  const char* const begin;
  const char* reached;  // behind the last character that was read
  std::size_t offset = 0;
  std::string message;
  int depth = 0;
  std::size_t values = 0;

  explicit SyntaxCheck(const std::string& text)
      : length(text.size()), begin(text.data()), reached(text.data()) {}

  /// At the bracket, or at the end of the value, that was read last.
  void note_place() { offset = reached > begin ? static_cast<std::size_t>(reached - begin) - 1 : 0; }

  bool count() {
    if (++values <= max_values) return true;
    note_place();
    message = "has too many values: " + std::to_string(max_values) + " are allowed";
    return false;
  }
  bool enter() {
    if (!count()) return false;
    if (++depth <= deepest) return true;
    note_place();
    message = "is nested too deeply: " + std::to_string(deepest) + " levels are allowed";
    return false;
  }
  bool leave() {
    --depth;
    return true;
  }

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool key(string_t&) override { return true; }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const json::exception& error) override {
    offset = position > 0 ? position - 1 : 0;
    message = error.id == 406     ? "the number " + last_token + " is too large"
              : position > length ? std::string("is not JSON: the text ends too early")
                                  : "is not JSON from here on: unexpected '" + last_token + "'";
    return false;
  }
};

/// Says how far it has come: the library names a place only for errors of its own.
class Reader {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Reader() = default;
  Reader(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  Reader& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  Reader operator++(int) {
    const Reader before = *this;
    ++*this;
    return before;
  }
  bool operator==(const Reader& other) const { return at_ == other.at_; }

 private:
  const char* at_ = nullptr;
  const char** reached_ = nullptr;
};

}  // namespace

std::optional<Problem> syntax_problem(const std::string& text, const std::string& place) {
  SyntaxCheck syntax(text);
  const Reader begin(text.data(), &syntax.reached), end(text.data() + text.size(), &syntax.reached);
  if (json::sax_parse(begin, end, &syntax)) return std::nullopt;
  const TextPosition at = position_of(text, std::min(syntax.offset, text.size()));
  return Problem{"", "", syntax.message, place, at.line, at.column};
}

std::string indented_json(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n' && i + 1 == text.size()) break;
    result += text[i];
    if (text[i] == '\n') result += "  ";
  }
  return result;
}

}  // namespace cloth
