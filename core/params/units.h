// The units that are read and shown, and their prefixes.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace cloth {

enum Base : std::size_t { length, mass, time, angle, bases };
using Powers = std::array<int, bases>;

/// value * 10^tens * (pi/180)^degrees of the powers.
struct KnownUnit {
  std::string_view name;
  bool takes_prefix;
  double value;
  int tens;
  Powers powers;
  int degrees = 0;
};

inline constexpr std::array<KnownUnit, 15> known_units{{
    {"m", true, 1, 0, {1, 0, 0, 0}},
    {"g", true, 1, -3, {0, 1, 0, 0}},
    {"s", true, 1, 0, {0, 0, 1, 0}},
    {"min", false, 60, 0, {0, 0, 1, 0}},
    {"h", false, 3600, 0, {0, 0, 1, 0}},
    {"Hz", true, 1, 0, {0, 0, -1, 0}},
    {"N", true, 1, 0, {1, 1, -2, 0}},
    {"gf", true, 9.80665, -3, {1, 1, -2, 0}},
    {"Pa", true, 1, 0, {-1, 1, -2, 0}},
    {"J", true, 1, 0, {2, 1, -2, 0}},
    {"W", true, 1, 0, {2, 1, -3, 0}},
    {"rad", true, 1, 0, {0, 0, 0, 1}},
    {"deg", false, 1, 0, {0, 0, 0, 1}, 1},
    {"°", false, 1, 0, {0, 0, 0, 1}, 1},
    {"%", false, 1, -2, {0, 0, 0, 0}},
}};

struct Prefix {
  std::string_view name;
  int tens;
  bool is_shown;
};

inline constexpr std::array<Prefix, 13> prefixes{{{"", 0, true},
                                                  {"m", -3, true},
                                                  {"k", 3, true},
                                                  {"µ", -6, true},
                                                  {"M", 6, true},
                                                  {"n", -9, true},
                                                  {"G", 9, true},
                                                  {"p", -12, true},
                                                  {"T", 12, true},
                                                  {"u", -6, false},
                                                  {"c", -2, false},
                                                  {"d", -1, false},
                                                  {"h", 2, false}}};

inline const KnownUnit* known_unit(std::string_view name) {
  const auto found = std::find_if(known_units.begin(), known_units.end(),
                                  [&](const KnownUnit& unit) { return unit.name == name; });
  return found == known_units.end() ? nullptr : &*found;
}

}  // namespace cloth
