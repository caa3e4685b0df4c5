// Numbers as text and back, the same under every locale: the decimal sign is a point, thousands have no sign.
#pragma once

#include <QString>
#include <optional>

namespace clothlab {

/// Six significant digits, shortest form: 0.1, 1e-5, 123457.
QString short_text(double value);

/// The shortest form that reads back to the same number.
QString exact_text(double value);

/// The number that a person typed: a decimal point, an exponent ("1e-4"), a unit after it if it is this one.
/// Nothing else is a number; neither is a part of the text, nor infinity.
std::optional<double> number_from(const QString& text, const QString& unit = {});

}  // namespace clothlab
