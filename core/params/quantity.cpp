#include "params/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "params/units.h"

namespace cloth {
namespace {

/// value * 10^tens * (pi/180)^degrees of these powers of m, kg, s and rad. Powers of ten and of a degree stay
/// apart, so that 0.3 ms is the double nearest to 0.0003, and 90 deg are 90 deg.
struct Term {
  double value = 1;
  int tens = 0;
  Powers powers{};
  int degrees = 0;
  bool has_unit = false;
  std::string literal{};  ///< value as typed, while it is one decimal number
};

std::optional<Term> unit_named(std::string_view name) {
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.name)) continue;
    const KnownUnit* unit = known_unit(name.substr(prefix.name.size()));
    if (!unit || (prefix.tens != 0 && !unit->takes_prefix)) continue;
    return Term{unit->value, unit->tens + prefix.tens, unit->powers, unit->degrees, true};
  }
  return std::nullopt;
}

/// A decimal number times 10^tens, rounded once; nothing if a double cannot hold it.
std::optional<double> decimal_value(std::string_view decimal, int tens) {
  const std::size_t mark = decimal.find_first_of("eE");
  int exponent = 0;
  if (mark != std::string_view::npos) {
    const char* from = decimal.data() + mark + 1;
    if (*from == '+') ++from;
    if (std::from_chars(from, decimal.data() + decimal.size(), exponent).ec != std::errc()) return {};
    if (std::abs(exponent) > 9999) return {};
  }
  const std::string text = fmt::format("{}e{}", decimal.substr(0, mark), exponent + tens);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
  return value;
}

/// The term's number in powers of ten and degrees of another.
double number_in(const Term& term, int tens, int degrees) {
  if (!std::isfinite(term.value)) return term.value;
  const double turned = term.value * std::pow(std::numbers::pi / 180, term.degrees - degrees);
  const bool is_literal = !term.literal.empty() && term.degrees == degrees;
  return decimal_value(is_literal ? term.literal : fmt::format("{}", turned), term.tens - tens)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

struct Refused {
  std::string rule;
};

/// Replaces signs of typography by those of the grammar.
std::string plain(std::string_view typed) {
  static constexpr std::array<std::pair<const char*, const char*>, 13> signs{{{"−", "-"},
                                                                              {"·", "*"},
                                                                              {"⋅", "*"},
                                                                              {"×", "*"},
                                                                              {"²", "^2"},
                                                                              {"³", "^3"},
                                                                              {"⁻¹", "^-1"},
                                                                              {"⁻²", "^-2"},
                                                                              {"π", "pi"},
                                                                              {"μ", "µ"},
                                                                              {"\u00a0", " "},
                                                                              {"\u202f", " "},
                                                                              {"\u2009", " "}}};
  std::string text(typed);
  for (const auto& [sign, instead] : signs)
    for (std::size_t at = text.find(sign); at != std::string::npos; at = text.find(sign, at))
      text.replace(at, std::string_view(sign).size(), instead);
  return text;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Letters, "%", and the bytes of "µ" and "°".
bool is_in_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' ||
         static_cast<unsigned char>(c) >= 0x80;
}

/// Reads an expression by recursive descent. What is wrong first is thrown.
class Reader {
 public:
  Reader(std::string_view text, bool decimal_comma) : text_(text), decimal_comma_(decimal_comma) {}

  Term whole() {
    const Term out = sum();
    if (next() != 0) refuse();
    return out;
  }

 private:
  [[noreturn]] static void refuse() {
    throw Refused{"must be a number, an expression or a quantity, like 1.5, 2*pi or 0.3 ms"};
  }

  /// The next character that is no space; 0 at the end.
  char next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    return true;
  }

  Term sum() {
    Term out = product();
    while (next() == '+' || next() == '-') {
      const double sign = text_[at_++] == '+' ? 1 : -1;
      const Term other = product();
      if (other.powers != out.powers || (other.has_unit != out.has_unit))
        throw Refused{"must add quantities of the same unit"};
      out.value += sign * number_in(other, out.tens, out.degrees);
      out.literal.clear();
    }
    return out;
  }

  Term product() {
    Term out = factor();
    while (true) {
      if (take('*'))
        multiply(out, factor(), 1);
      else if (take('/'))
        multiply(out, factor(), -1);
      else if (next() == '(' || is_in_name(next()))
        multiply(out, power(), 1);
      else if (is_at_reciprocal())
        multiply(out, number(), 1);
      else
        return out;
    }
  }

  /// At "1/s" and the like, as in "0.2 1/s"; "2 1/2" is nothing.
  bool is_at_reciprocal() {
    return next() == '1' && at_ + 2 < text_.size() && text_[at_ + 1] == '/' && is_in_name(text_[at_ + 2]);
  }

  static void multiply(Term& out, const Term& by, int sign) {
    out.value = sign > 0 ? out.value * by.value : out.value / by.value;
    if (by.value != 1) out.literal.clear();
    out.tens += sign * by.tens;
    out.degrees += sign * by.degrees;
    for (std::size_t k = 0; k < bases; ++k) out.powers[k] += sign * by.powers[k];
    out.has_unit = out.has_unit || by.has_unit;
  }

  Term factor() {
    if (take('+')) return factor();
    if (!take('-')) return power();
    Term out = factor();
    out.value = -out.value;
    if (!out.literal.empty()) out.literal.insert(0, "-");
    return out;
  }

  Term power() {
    Term out = primary();
    if (!take('^')) return out;
    const double sign = take('-') ? -1 : 1;
    const Term exponent = primary();
    const double by = sign * exponent.value;
    if (exponent.has_unit) throw Refused{"must have a pure number as an exponent"};
    raise(out, by);
    return out;
  }

  static void raise(Term& out, double by) {
    out.value = std::pow(out.value, by);
    out.literal.clear();
    if (!out.has_unit) return;
    constexpr double largest = 9;
    if (by != std::round(by) || std::abs(by) > largest)
      throw Refused{"must have whole numbers as exponents of units"};
    out.tens *= static_cast<int>(by);
    out.degrees *= static_cast<int>(by);
    for (int& dimension : out.powers) dimension *= static_cast<int>(by);
  }

  Term primary() {
    if (take('(')) {
      const Term out = sum();
      if (!take(')')) refuse();
      return out;
    }
    if (is_digit(next()) || next() == '.' || next() == ',') return number();
    if (is_in_name(next())) return name();
    refuse();
  }

  Term number() {
    const auto digits = [this] {
      while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.' || text_[at_] == ',')) ++at_;
    };
    const std::size_t from = at_;
    digits();
    std::string decimal(text_.substr(from, at_ - from));
    if (decimal.find(',') != std::string::npos && !decimal_comma_)
      throw Refused{"must be a number with a decimal point, like 1.5"};
    std::replace(decimal.begin(), decimal.end(), ',', '.');
    std::size_t after = at_ + 1;
    if (after < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      if (text_[after] == '+' || text_[after] == '-') ++after;
      if (after < text_.size() && is_digit(text_[after])) {
        const std::size_t mark = at_;
        for (at_ = after; at_ < text_.size() && is_digit(text_[at_]);) ++at_;
        decimal += text_.substr(mark, at_ - mark);
      }
    }
    if (std::count(decimal.begin(), decimal.end(), '.') > 1 || decimal == ".") refuse();
    const auto value = decimal_value(decimal, 0);
    if (!value) throw Refused{"must be a number that a double can hold, up to 1e308"};
    return {.value = *value, .literal = decimal};
  }

  Term name() {
    const std::size_t from = at_;
    while (at_ < text_.size() && is_in_name(text_[at_])) ++at_;
    const std::string_view name = text_.substr(from, at_ - from);
    if (name == "pi") return Term{std::numbers::pi};
    if (auto unit = unit_named(name)) {
      if (at_ < text_.size() && (text_[at_] == '2' || text_[at_] == '3'))  // as in "gf cm2/cm"
        raise(*unit, text_[at_++] - '0');
      return *unit;
    }
    throw Refused{fmt::format("must be written with known units: \"{}\" is none", name)};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool decimal_comma_;
};

Term unit_term(const std::string& unit) {
  return unit.empty() ? Term{} : Reader(unit, false).whole();
}

/// "N/m" where these powers have a name, else "kg/m²" and the like.
std::string powers_text(const Powers& powers) {
  for (const char* unit : {"N", "N/m", "N s/m", "Hz", "Pa", "J", "W"})
    if (unit_term(unit).powers == powers) return shown_unit(unit);
  static constexpr std::array<const char*, bases> names{"m", "kg", "s", "rad"};
  std::string above, below;
  for (const std::size_t k : {mass, length, time, angle}) {
    if (powers[k] == 0) continue;
    std::string& side = powers[k] > 0 ? above : below;
    if (!side.empty()) side += ' ';
    side += names[k];
    if (std::abs(powers[k]) > 1) side += fmt::format("^{}", std::abs(powers[k]));
  }
  if (above.empty()) above = "1";
  return shown_unit(below.empty() ? above : above + "/" + below);
}

/// Whether a stiffness is wanted in N/m and given over an angle too, as shear is measured: in gf/(cm deg) or
/// N/(m rad).
bool is_per_angle(Powers given, const Powers& wanted) {
  constexpr Powers stiffness{0, 1, -2, 0};
  return wanted == stiffness && given[angle]++ == -1 && given == wanted;
}

}  // namespace

Quantity quantity_from(std::string_view text, const std::string& unit, bool decimal_comma) {
  constexpr std::size_t longest = 256;  // bounds the depth of brackets
  if (text.size() > longest) return {.rule = fmt::format("must be no longer than {} characters", longest)};
  try {
    const std::string typed = plain(text);
    const Term wanted = unit_term(unit);
    Term found = Reader(typed, decimal_comma).whole();
    if (found.has_unit)
      found.value /= wanted.value;
    else
      found.powers = wanted.powers, found.tens = wanted.tens, found.degrees = wanted.degrees;
    if (is_per_angle(found.powers, wanted.powers)) found.powers[angle] = 0;
    if (found.powers != wanted.powers) {
      const bool is_pure = found.powers == Powers{};
      const std::string not_in = is_pure ? "a pure number" : "in " + powers_text(found.powers);
      return {.rule = unit.empty() ? "must be a pure number, not " + not_in
                                   : fmt::format("must be in {}, not {}", shown_unit(unit), not_in)};
    }
    const double value = number_in(found, wanted.tens, wanted.degrees);
    if (!std::isfinite(value)) return {.rule = "must be a finite number"};
    return {.value = value};
  } catch (const Refused& refused) {
    return {.rule = refused.rule};
  }
}

}  // namespace cloth
