#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "params/quantity.h"
#include "params/units.h"

namespace cloth {
namespace {

/// The digits of a number and the power of ten of the first: -9.81 is "981" and 0, without its sign.
struct Decimal {
  std::string digits;
  int exponent = 0;
};

Decimal decimal_of(double value, int digits) {
  std::array<char, 40> buffer;
  const double size = std::abs(value);
  const auto end =
      digits == all_digits
          ? std::to_chars(buffer.begin(), buffer.end(), size, std::chars_format::scientific)
          : std::to_chars(buffer.begin(), buffer.end(), size, std::chars_format::scientific, digits - 1);
  const std::string text(buffer.begin(), end.ptr);
  const std::size_t mark = text.find('e');
  Decimal out{text.substr(0, mark), std::stoi(text.substr(mark + 1))};
  std::erase(out.digits, '.');
  out.digits.erase(out.digits.find_last_not_of('0') + 1);
  return out;
}

/// The power of ten of the unit's prefix, and what stands after it: "kg" is 3 and "g".
std::pair<int, std::string> without_prefix(const std::string& unit) {
  if (!known_unit(unit))
    for (const Prefix& prefix : prefixes)
      if (unit.starts_with(prefix.name) && known_unit(unit.substr(prefix.name.size())))
        return {prefix.tens, unit.substr(prefix.name.size())};
  return {0, unit};
}

/// "0.0981", "9.81", "981", "98100"
std::string fixed_text(Decimal decimal, bool is_negative) {
  std::string& digits = decimal.digits;
  if (decimal.exponent < 0) digits.insert(0, static_cast<std::size_t>(-decimal.exponent), '0');
  const std::size_t whole = static_cast<std::size_t>(std::max(decimal.exponent, 0)) + 1;
  if (digits.size() < whole) digits.append(whole - digits.size(), '0');
  if (digits.size() > whole) digits.insert(whole, 1, '.');
  return (is_negative ? "-" : "") + digits;
}

}  // namespace

std::string shown_unit(std::string unit) {
  static constexpr std::array<std::pair<const char*, const char*>, 3> signs{
      {{"^2", "²"}, {"^3", "³"}, {" ", "·"}}};
  for (const auto& [sign, instead] : signs)
    for (std::size_t at = unit.find(sign); at != std::string::npos; at = unit.find(sign, at))
      unit.replace(at, std::string_view(sign).size(), instead);
  return unit;
}

std::string shown_number(double value, int digits) {
  std::array<char, 40> buffer;
  const auto end = digits == all_digits ? std::to_chars(buffer.begin(), buffer.end(), value)
                                        : std::to_chars(buffer.begin(), buffer.end(), value,
                                                        std::chars_format::general, digits);
  const std::string text(buffer.begin(), end.ptr);
  const std::size_t mark = text.find('e');
  if (mark == std::string::npos) return text;
  return fmt::format("{}e{}", text.substr(0, mark), std::stoi(text.substr(mark + 1)));
}

ShownQuantity shown_quantity(double value, const std::string& unit, int digits) {
  const ShownQuantity bare{shown_number(value, digits), shown_unit(unit)};
  const std::size_t end = std::min(unit.find_first_of(" /^"), unit.size());
  const auto [own, symbol] = without_prefix(unit.substr(0, end));
  const KnownUnit* known = known_unit(symbol);
  const bool is_power = end < unit.size() && unit[end] == '^';
  if (!known || !known->takes_prefix || is_power || value == 0 || !std::isfinite(value)) return bare;
  const int largest = symbol == "s" ? 0 : symbol == "g" ? 3 : 12;
  Decimal decimal = decimal_of(value, digits);
  for (const int tens : {0, -3, 3, -6, 6, -9, 9, -12, 12}) {
    const int exponent = decimal.exponent - tens;
    if (exponent < -1 || exponent > 2 || tens + own > largest) continue;
    const auto prefix =
        std::find_if(prefixes.begin(), prefixes.end(),
                     [&, tens = tens + own](const Prefix& one) { return one.is_shown && one.tens == tens; });
    if (prefix == prefixes.end()) continue;
    decimal.exponent = exponent;
    return {fixed_text(decimal, value < 0),
            shown_unit(std::string(prefix->name) + symbol + unit.substr(end))};
  }
  return bare;
}

}  // namespace cloth
