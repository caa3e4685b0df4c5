// A small strict reader of XML, for tests of what the reports write.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace cloth::test {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;  // with entities resolved
  std::string text;                               // directly inside, entities resolved
  std::vector<XmlElement> children;
};

struct XmlDocument {
  XmlElement root;
  std::string error;  // empty: well-formed
};

/// One root element, tags that match, quoted and unique attributes, only the five entities and &#N;.
/// Comments, declarations and CDATA are errors: the reports write none.
XmlDocument read_xml(const std::string& text);

/// The element itself and all below, in the order of the text.
std::vector<const XmlElement*> all_elements(const XmlElement& root);
std::vector<const XmlElement*> all_elements(XmlElement&&) = delete;  // they would point at nothing

}  // namespace cloth::test
