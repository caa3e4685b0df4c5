// Converts the declarations' ASCII to displayed text, and numbers to text and back, independent of the
// locale: decimal point, no thousands separator.
#pragma once

#include <QString>
#include <optional>
#include <string>

#include "params/parameter.h"
#include "scene/scene_parameters.h"

namespace clothlab {

/// "m/s^2" -> "m/s²", "N s/m" -> "N·s/m"
QString unit_text(const std::string& unit);

/// ">=" -> "≥", "<=" -> "≤", and so on.
QString typographic(const QString& text);

/// "semi-implicit-euler" -> "Semi-implicit Euler"
QString choice_text(const std::string& word);

/// {"structural", "shear"} -> "Structural and shear"; none -> "None"
QString words_text(const cloth::Words& words);

/// The displayed text of a value, with its unit.
QString value_in_words(const cloth::ParameterInfo& info, const cloth::ParameterValue& value);

/// Meaning, formula, range, default, unit, cost and path of a parameter, as rich text.
QString tooltip_of(const cloth::Parameter& parameter, const std::optional<cloth::ParameterValue>& fallback);

/// Six significant digits, shortest form: 0.1, 1e-5, 123457.
QString short_text(double value);

/// The shortest form that reads back to the same number.
QString exact_text(double value);

/// The number that a person typed: a decimal point, an exponent ("1e-4"), a unit after it if it is this one.
/// Nothing else is a number; neither is a part of the text, nor infinity.
std::optional<double> number_from(const QString& text, const QString& unit = {});

}  // namespace clothlab
