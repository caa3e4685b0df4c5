#include "scene/json_syntax.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/json_locator.h"

namespace cloth {
namespace {

using json = nlohmann::json;

/// Only notes where and why a text is not JSON, or is nested so deeply that it cannot be a scene.
struct SyntaxCheck : nlohmann::json_sax<json> {
  static constexpr int deepest = 64;
  const std::size_t length;  // of the text
  std::size_t offset = 0;
  std::string message;
  int depth = 0;

  explicit SyntaxCheck(std::size_t text_length) : length(text_length) {}

  bool enter() {
    if (++depth <= deepest) return true;
    message = "is nested too deeply for a scene";
    return false;
  }
  bool leave() {
    --depth;
    return true;
  }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
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

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return text;
}

}  // namespace

std::optional<Problem> syntax_problem(const std::string& text, const std::string& place) {
  SyntaxCheck syntax(text.size());
  if (json::sax_parse(text, &syntax)) return std::nullopt;
  const TextPosition at = position_of(text, std::min(syntax.offset, text.size()));
  return Problem{"", "", printable(syntax.message), place, at.line, at.column};
}

}  // namespace cloth
