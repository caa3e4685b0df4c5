#include "io/json_locator.h"

#include <algorithm>

#include "params/parameter.h"

namespace cloth {
namespace {

class Locator {
 public:
  explicit Locator(std::string_view text) : text_(text) {}

  JsonLocations run() {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.substr(0, byte_order_mark.size()) == byte_order_mark) at_ = byte_order_mark.size();
    skip_space();
    value("");
    return std::move(locations_);
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  /// Of the next character. Lines are counted on from the last call: a long text is not read over and over.
  TextPosition position() {
    for (; counted_ < at_; ++counted_)
      if (text_[counted_] == '\n') ++line_, line_begin_ = counted_ + 1;
    return {line_, static_cast<int>(at_ - line_begin_) + 1};
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  /// Skips punctuation and the space around it.
  void skip_mark() {
    ++at_;
    skip_space();
  }

  /// The raw characters between the quotes; escapes are of no interest to a path.
  std::string string() {
    const std::size_t begin = ++at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    const std::string content(text_.substr(begin, at_ - begin));
    ++at_;
    return content;
  }

  void value(const std::string& path) {
    locations_.values.insert_or_assign(path, position());
    if (peek() == '{')
      object(path);
    else if (peek() == '[')
      array(path);
    else if (peek() == '"')
      string();
    else
      while (at_ < text_.size() && std::string_view(",]} \t\r\n").find(text_[at_]) == std::string_view::npos)
        ++at_;
    skip_space();
  }

  void object(const std::string& path) {
    skip_mark();
    while (at_ < text_.size() && peek() != '}') {
      const TextPosition key_position = position();
      const std::string member = joined_path(path, string());
      if (!locations_.keys.insert_or_assign(member, key_position).second)
        locations_.repeated.push_back(member);
      skip_space();
      skip_mark();  // the colon
      value(member);
      if (peek() == ',') skip_mark();
    }
    ++at_;
  }

  void array(const std::string& path) {
    skip_mark();
    for (int index = 0; at_ < text_.size() && peek() != ']'; ++index) {
      value(joined_path(path, std::to_string(index)));
      if (peek() == ',') skip_mark();
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0, counted_ = 0, line_begin_ = 0;
  int line_ = 1;
  JsonLocations locations_;
};

}  // namespace

TextPosition position_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {static_cast<int>(line), static_cast<int>(before.size() - line_begin) + 1};
}

JsonLocations locate_json(std::string_view text) {
  return Locator(text).run();
}

TextPosition JsonLocations::place_of(std::string path, bool of_key) const {
  if (const auto key = keys.find(path); of_key && key != keys.end()) return key->second;
  while (!values.count(path))
    path = path.substr(0, path.rfind('.') == std::string::npos ? 0 : path.rfind('.'));
  return values.at(path);
}

void JsonLocations::put_in_place(Problem& problem, const std::string& place) const {
  const TextPosition at = place_of(problem.path, problem.value.empty());
  problem.place = place;
  problem.line = at.line, problem.column = at.column;
}

std::vector<Problem> JsonLocations::repetitions() const {
  std::vector<Problem> problems;
  for (const std::string& path : repeated)
    problems.push_back({path, "", "is given more than once", "", 0, 0});
  return problems;
}

void sort_by_place(std::vector<Problem>& problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
}

}  // namespace cloth
