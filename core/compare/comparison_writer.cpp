#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"
#include "io/json_syntax.h"

namespace cloth {
namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
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
  text += fmt::format("  \"scene\": {},\n  \"panes\": [\n", indented_json(write_scene(comparison.scene)));
  for (std::size_t i = 0; i < comparison.panes.size(); ++i)
    text += pane_text(comparison.panes[i]) + (i + 1 < comparison.panes.size() ? ",\n" : "\n");
  return text + fmt::format("  ],\n  \"reference\": {}\n}}\n", quoted(comparison.reference));
}

}  // namespace cloth
