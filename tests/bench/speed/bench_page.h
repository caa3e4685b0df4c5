// What the tables of clothlab-bench are put together with.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "report/text_table.h"

namespace cloth::speed {

/// Text or Markdown, built from the same paragraphs and tables.
class Page {
 public:
  explicit Page(bool markdown) : markdown_(markdown) {}

  void heading(const std::string& text) { text_ += (markdown_ ? "\n## " : "\n") + text + "\n"; }
  void paragraph(const std::string& text) { text_ += (markdown_ ? "\n" : "") + text + "\n"; }
  void table(const TextTable& table) { text_ += markdown_ ? "\n" + to_markdown(table) : to_text(table); }
  std::string take() { return std::move(text_); }

 private:
  bool markdown_;
  std::string text_;
};

/// Some three significant digits, without an exponent where it can be.
inline std::string number(double value) {
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size < 0.1) return fmt::format("{:.2g}", value);
  return fmt::format("{:.{}f}", value, size < 10 ? 2 : size < 100 ? 1 : 0);
}

}  // namespace cloth::speed
