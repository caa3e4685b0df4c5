#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"

namespace cloth {
namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// `text` with two more spaces before each line but the first; a JSON text has no line ends within its
/// strings.
std::string indented(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    result += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) result += "  ";
  }
  if (!result.empty() && result.back() == '\n') result.pop_back();
  return result;
}

std::string pane_text(const Pane& pane) {
  std::string text = fmt::format("    {{\n      \"name\": {},\n", quoted(pane.name));
  if (!pane.title.empty()) text += fmt::format("      \"title\": {},\n", quoted(pane.title));
  text += "      \"own\": {";
  const char* separator = "\n";
  for (const OwnValue& own : pane.own) {
    text += fmt::format("{}        {}: {}", separator, quoted(own.path), value_json(own.value));
    separator = ",\n";
  }
  return text + (pane.own.empty() ? "}\n    }" : "\n      }\n    }");
}

}  // namespace

std::string write_comparison(const Comparison& comparison) {
  std::string text = fmt::format("{{\n  \"format\": {},\n", quoted(comparison_format));
  text += fmt::format("  \"title\": {},\n", quoted(comparison.title));
  text += fmt::format("  \"scene\": {},\n  \"panes\": [\n", indented(write_scene(comparison.scene)));
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    text += pane_text(comparison.panes[i]) + (i + 1 < comparison.panes.size() ? ",\n" : "\n");
  return text + fmt::format("  ],\n  \"reference\": {}\n}}\n", quoted(comparison.reference));
}

}  // namespace cloth
