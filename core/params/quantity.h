// Numbers with units: what a person typed, read as a value of one unit, and a value as it is shown. Both
// know the SI's prefixes; neither follows the locale of the process.
#pragma once

#include <string>
#include <string_view>

namespace cloth {

/// A value in the unit that was asked for, or the rule that the text breaks ("must be in N/m, not in kg").
struct Quantity {
  double value = 0;
  std::string rule{};  ///< empty: there is a value

  bool ok() const { return rule.empty(); }
};

/// The value of an expression: numbers, `+ - * / ^`, brackets, `pi` and units with SI prefixes, as in
/// "0.3 ms", "5 cN/mm", "2*pi", "0.1 gf cm2/cm" or "1/60 s". From left to right: "1/60 s" is a sixtieth of a
/// second. A result without any unit is in `unit`. With `decimal_comma`, "1,5" is a number, too. The value of
/// a number with one unit is the double nearest to the decimal that was typed. A stiffness in N/m may be
/// given per angle: "0.8 gf/(cm deg)" is that per rad.
Quantity quantity_from(std::string_view text, const std::string& unit, bool decimal_comma = false);

/// A value as it is shown: the number, and the unit with a prefix, both in typographic form.
struct ShownQuantity {
  std::string number, unit;

  std::string text() const { return unit.empty() ? number : number + " " + unit; }
};

/// As many digits as it takes to read back the same number.
inline constexpr int all_digits = 0;

/// The prefix nearest to none by which the number is at least 0.1 and under 1000 (0.909 ms, 500 N/m,
/// 54.3 kN/m); `unit` may have one itself. Nothing is larger than the second and the kilogram; degrees have
/// no prefix.
ShownQuantity shown_quantity(double value, const std::string& unit, int digits);

/// The shortest form with at most so many significant digits: 0.1, 1e-5, 123457.
std::string shown_number(double value, int digits);

/// "m/s^2" -> "m/s²", "N s/m" -> "N·s/m"
std::string shown_unit(std::string unit);

}  // namespace cloth
