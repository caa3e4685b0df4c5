// Converts the declarations' ASCII to displayed text.
#pragma once

#include <QString>
#include <optional>
#include <string>

#include "params/parameter.h"
#include "scene/scene_parameters.h"

namespace clothlab {

/// "m/s^2" -> "m/s²", "N s/m" -> "N·s/m"
QString unit_text(const std::string& unit);

/// ">=" -> "≥", "<=" -> "≤", and so on; numbers as the locale has them.
QString typographic(const QString& text);

/// "semi-implicit-euler" -> "Semi-implicit Euler"
QString choice_text(const std::string& word);

/// {"structural", "shear"} -> "Structural and shear"; none -> "None"
QString words_text(const cloth::Words& words);

/// The displayed text of a value, with its unit.
QString value_in_words(const cloth::ParameterInfo& info, const cloth::ParameterValue& value);

/// Meaning, formula, range, default, unit, cost and path of a parameter, as rich text.
QString tooltip_of(const cloth::Parameter& parameter, const std::optional<cloth::ParameterValue>& fallback);

}  // namespace clothlab
