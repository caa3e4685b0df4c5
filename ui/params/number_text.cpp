#include "params/number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace clothlab {
namespace {

/// "1e-05" -> "1e-5", "1e+20" -> "1e20"
QString with_short_exponent(const char* begin, const char* end) {
  QString text = QString::fromLatin1(begin, end - begin);
  const qsizetype mark = text.indexOf('e');
  if (mark < 0) return text;
  QString exponent = text.mid(mark + 1);
  const bool negative = exponent.startsWith('-');
  if (negative || exponent.startsWith('+')) exponent.remove(0, 1);
  while (exponent.size() > 1 && exponent.startsWith('0')) exponent.remove(0, 1);
  return text.left(mark + 1) + (negative ? "-" : "") + exponent;
}

}  // namespace

QString short_text(double value) {
  std::array<char, 40> buffer;
  const auto result = std::to_chars(buffer.begin(), buffer.end(), value, std::chars_format::general, 6);
  return with_short_exponent(buffer.begin(), result.ptr);
}

QString exact_text(double value) {
  std::array<char, 40> buffer;
  const auto result = std::to_chars(buffer.begin(), buffer.end(), value);
  return with_short_exponent(buffer.begin(), result.ptr);
}

std::optional<double> number_from(const QString& text, const QString& unit) {
  QString bare = text.trimmed();
  if (!unit.isEmpty() && bare.endsWith(unit)) bare = bare.chopped(unit.size()).trimmed();
  bare.replace(QChar(0x2212), '-');  // the typographic minus, as it comes out of papers
  if (bare.startsWith('+') && !bare.startsWith("+-")) bare.remove(0, 1);
  const std::string ascii = bare.toStdString();
  double value = 0;
  const auto [stop, error] = std::from_chars(ascii.data(), ascii.data() + ascii.size(), value);
  if (error != std::errc() || stop != ascii.data() + ascii.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace clothlab
