#include "support/xml.h"

#include <stdexcept>

namespace cloth::test {
namespace {

class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  XmlElement document() {
    skip_space();
    XmlElement root = element();
    skip_space();
    if (at_ != text_.size()) fail("text after the root element");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(what + " at byte " + std::to_string(at_) + ": " + text_.substr(at_, 60));
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool accept(const std::string& expected) {
    if (text_.compare(at_, expected.size(), expected) != 0) return false;
    at_ += expected.size();
    return true;
  }
  void expect(const std::string& expected) {
    if (!accept(expected)) fail("expected " + expected);
  }
  void skip_space() {
    while (peek() == ' ' || peek() == '\n' || peek() == '\t') ++at_;
  }

  std::string name() {
    const std::size_t start = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '-' || peek() == '_' ||
           peek() == ':')
      ++at_;
    if (at_ == start) fail("expected a name");
    return text_.substr(start, at_ - start);
  }

  std::string entity() {
    expect("&");
    for (const auto& [written, meant] :
         {std::pair{"amp;", "&"}, {"lt;", "<"}, {"gt;", ">"}, {"quot;", "\""}, {"#39;", "'"}})
      if (accept(written)) return meant;
    fail("unknown entity");
  }

  /// Until one of the two characters.
  std::string characters(char end, char other_end) {
    std::string out;
    while (peek() != end && peek() != other_end) {
      if (at_ >= text_.size()) fail("the text ends too early");
      if (peek() == '<') fail("< inside a value");
      if (static_cast<unsigned char>(peek()) < 0x20 && peek() != '\n' && peek() != '\t')
        fail("control character");
      if (peek() == '&')
        out += entity();
      else
        out += text_[at_++];
    }
    return out;
  }

  XmlElement element() {
    expect("<");
    XmlElement out;
    out.name = name();
    for (;;) {
      const bool space = peek() == ' ' || peek() == '\n';
      skip_space();
      if (accept("/>")) return out;
      if (accept(">")) break;
      if (!space) fail("expected a space before an attribute");
      const std::string key = name();
      expect("=\"");
      if (!out.attributes.emplace(key, characters('"', '"')).second) fail("attribute twice: " + key);
      expect("\"");
    }
    for (;;) {
      out.text += characters('<', '<');
      if (accept("</")) {
        if (name() != out.name) fail("wrong end tag in " + out.name);
        expect(">");
        return out;
      }
      out.children.push_back(element());
    }
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

void collect(const XmlElement& element, std::vector<const XmlElement*>& all) {
  all.push_back(&element);
  for (const XmlElement& child : element.children) collect(child, all);
}

}  // namespace

XmlDocument read_xml(const std::string& text) {
  XmlDocument document;
  try {
    document.root = Reader(text).document();
  } catch (const std::runtime_error& error) {
    document.error = error.what();
  }
  return document;
}

std::vector<const XmlElement*> all_elements(const XmlElement& root) {
  std::vector<const XmlElement*> all;
  collect(root, all);
  return all;
}

}  // namespace cloth::test
