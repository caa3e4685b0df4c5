// Numbers with units: what a person types is read, and what is shown reads back.
#include "params/quantity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/builtin_scenes.h"
#include "scene/scene_parameters.h"

namespace cloth::test::quantity_test {
namespace {

double value(const char* text, const char* unit) {
  const Quantity read = quantity_from(text, unit);
  EXPECT_TRUE(read.ok()) << text << ": " << read.rule;
  return read.value;
}

std::string rule(const char* text, const char* unit, bool decimal_comma = false) {
  const Quantity read = quantity_from(text, unit, decimal_comma);
  EXPECT_FALSE(read.ok()) << text << " is " << read.value;
  return read.rule;
}

std::string shown(double value, const char* unit, int digits = 6) {
  return shown_quantity(value, unit, digits).text();
}

TEST(Quantities, AreReadInTheirOwnUnitAndInOthers) {
  EXPECT_EQ(value("0.3 ms", "s"), 0.0003);
  EXPECT_EQ(value("5 cN/mm", "N/m"), 50);
  EXPECT_EQ(value("1E3 N/m", "N/m"), 1000);
  EXPECT_EQ(value("-9.81 m/s²", "m/s^2"), -9.81);
  EXPECT_EQ(value("0.2 mN·s/m", "N s/m"), 0.0002);
  EXPECT_EQ(value("0.2 mN s m^-1", "N s/m"), 0.0002);
  EXPECT_EQ(value("7 g", "kg"), 0.007);
  EXPECT_EQ(value("3 um", "m"), value("3 µm", "m"));
  EXPECT_EQ(value("3 μm", "m"), value("3 µm", "m"));  // the Greek letter
  EXPECT_EQ(value("36 km/h", "m/s"), 10);
  EXPECT_EQ(value("90 deg", "deg"), 90);
  EXPECT_EQ(value("90°", "deg"), 90);
  EXPECT_DOUBLE_EQ(value("90°", "rad"), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(value("pi rad", "deg"), 180);
  EXPECT_EQ(value("15 %", ""), 0.15);
  EXPECT_EQ(value("0.2 1/s", "1/s"), 0.2);
  EXPECT_EQ(value("0.2/s", "1/s"), 0.2);
  rule("2 1/2", "");
}

TEST(Quantities, OfTheKawabataSystemAreReadAsItsSheetsWriteThem) {
  for (const char* text : {"0.1 gf cm2/cm", "0.1 gf cm^2/cm", "0.1 gf·cm²/cm", "0.1 gf cm"})
    EXPECT_DOUBLE_EQ(value(text, "N m"), 9.80665e-6) << text;
  EXPECT_DOUBLE_EQ(value("1 gf cm/cm", "N"), 9.80665e-3);
  EXPECT_DOUBLE_EQ(value("500 gf/cm", "N/m"), 490.3325);
  EXPECT_DOUBLE_EQ(value("1 gf/(cm deg)", "N/m"), 0.980665 * 180 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(value("30 N/m/rad", "N/m"), 30);
  EXPECT_DOUBLE_EQ(value("15 mg/cm2", "kg/m^2"), 0.15);
  EXPECT_DOUBLE_EQ(value("150 g/m2", "kg/m^2"), 0.15);
  EXPECT_EQ(value("2 m3", "m^3"), 2);
  EXPECT_EQ(rule("1 gf/deg", "N/m"), "must be in N/m, not in kg·m/s²·rad");
  EXPECT_EQ(rule("1 N deg/m", "N/m"), "must be in N/m, not in kg·rad/s²");
  rule("3 m22", "m^2");
}

TEST(Quantities, WithoutAUnitAreInTheFieldsOwn) {
  for (const char* unit : {"", "s", "kg", "N/m", "N s/m", "deg", "rad/s"}) {
    EXPECT_EQ(value("123.45678901234567", unit), 123.45678901234567) << unit;
    EXPECT_EQ(value("1e1*2", unit), 20) << unit;
    EXPECT_EQ(value("2*pi", unit), 2 * std::numbers::pi) << unit;
  }
}

TEST(Quantities, AreExpressions) {
  EXPECT_EQ(value("1 + 2*3", ""), 7);
  EXPECT_EQ(value("(1 + 2)*3", ""), 9);
  EXPECT_EQ(value("2(3 - 1)", ""), 4);
  EXPECT_EQ(value("-2^2", ""), -4);
  EXPECT_EQ(value("2^-1", ""), 0.5);
  EXPECT_EQ(value("8/2/2", ""), 2);
  EXPECT_EQ(value("2π", ""), 2 * std::numbers::pi);
  EXPECT_EQ(value("− 3", ""), -3);
  EXPECT_EQ(value("+ .5", ""), 0.5);
  EXPECT_EQ(value("1/60 s", "s"), 1.0 / 60);
  EXPECT_EQ(value("1/(4 ms)", "Hz"), 250);
  EXPECT_EQ(value("1 m + 5 mm", "m"), 1.005);
  EXPECT_EQ(value("10 N / (5 cm)", "N/m"), 200);
}

TEST(Quantities, OfAnotherKindAreRefusedWithBothUnits) {
  EXPECT_EQ(rule("5 kg", "N/m"), "must be in N/m, not in kg");
  EXPECT_EQ(rule("3 m", "N/m"), "must be in N/m, not in m");
  EXPECT_EQ(rule("3 kN", "m/s^2"), "must be in m/s², not in N");
  EXPECT_EQ(rule("5 %", "s"), "must be in s, not a pure number");
  EXPECT_EQ(rule("2 s", ""), "must be a pure number, not in s");
  EXPECT_EQ(rule("3 Hz", "rad/s"), "must be in rad/s, not in Hz");
  EXPECT_EQ(rule("1 m + 2", "m"), "must add quantities of the same unit");
  EXPECT_EQ(rule("3 furlongs", "m"), "must be written with known units: \"furlongs\" is none");
}

TEST(Quantities, WhatIsNoneIsRefused) {
  for (const char* text :
       {"",    " ",   "abc",  "nan", "inf",     "0x10",      "1 2",   "1.2.3",  "--",  "2*",
        "(1",  "1)",  "1..2", "e",   "1e",      "m2",        "1e999", "1e-999", "1/0", "9^999",
        "1;2", "1,5", "\xff", "^2",  "2^(1 m)", "(1 m)^0.5", "mmin",  "kkg"})
    for (const char* unit : {"", "m", "N/m"}) EXPECT_FALSE(quantity_from(text, unit).ok()) << text;
  EXPECT_FALSE(quantity_from(std::string(100000, '('), "").ok());
}

TEST(Quantities, TakeADecimalCommaWhereTheLocaleHasOne) {
  EXPECT_EQ(quantity_from("0,3 ms", "s", true).value, 0.0003);
  EXPECT_EQ(quantity_from("0.3 ms", "s", true).value, 0.0003);
  EXPECT_EQ(rule("1,5", "m"), "must be a number with a decimal point, like 1.5");
  rule("1.000,5", "m", true);
  rule("1,000,5", "m", true);
}

TEST(ShownQuantities, HaveThePrefixNearestToNone) {
  EXPECT_EQ(shown(0.000909091, "s", 3), "0.909 ms");
  EXPECT_EQ(shown(0.05, "s"), "50 ms");
  EXPECT_EQ(shown(0.5, "s"), "0.5 s");
  EXPECT_EQ(shown(5000, "s"), "5000 s");
  EXPECT_EQ(shown(500, "N/m"), "500 N/m");
  EXPECT_EQ(shown(54321.5, "N/m"), "54.3215 kN/m");
  EXPECT_EQ(shown(0.0002, "N s/m"), "0.2 mN·s/m");
  EXPECT_EQ(shown(999.9999, "N/m", 3), "1 kN/m");
  EXPECT_EQ(shown(0.02, "kg"), "20 g");
  EXPECT_EQ(shown(0.2, "kg"), "0.2 kg");
  EXPECT_EQ(shown(2000, "kg"), "2000 kg");
  EXPECT_EQ(shown(3e-7, "m"), "0.3 µm");
  EXPECT_EQ(shown(7.25, "ms"), "7.25 ms");
  EXPECT_EQ(shown(0.0123, "mm"), "12.3 µm");
  EXPECT_EQ(shown(5000, "ms"), "5 s");
  EXPECT_EQ(shown(-9.81, "m/s^2"), "-9.81 m/s²");
  EXPECT_EQ(shown(0.001, "deg"), "0.001 deg");
  EXPECT_EQ(shown(1e-5, ""), "1e-5");
  EXPECT_EQ(shown(0, "s"), "0 s");
  EXPECT_EQ(shown(1e-30, "s"), "1e-30 s");
  EXPECT_EQ(shown(0.00030000000000000003, "s", all_digits), "0.30000000000000003 ms");
}

TEST(ShownQuantities, OfEveryParameterReadBack) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin_scene(builtin.name);
    for (const Parameter& parameter : parameters_of(scene)) {
      if (parameter.info.kind != Kind::number) continue;
      for (int tens = -15; tens <= 15; ++tens)
        for (const double first : {1.0, 1.7, -2.345678901234567, 9.99999999999}) {
          const double one = first * std::pow(10.0, tens);
          const std::string text = shown_quantity(one, parameter.info.unit, all_digits).text();
          EXPECT_EQ(quantity_from(text, parameter.info.unit).value, one) << text;
        }
    }
  }
}

}  // namespace
}  // namespace cloth::test::quantity_test
