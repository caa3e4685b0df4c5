// How the window writes numbers and reads what is typed: units with SI prefixes, and a decimal comma where
// the locale has one. Files, copied tables and the command line have decimal points.
#pragma once

#include <QString>
#include <string>

#include "params/quantity.h"

namespace clothlab {

bool has_decimal_comma();

/// "0.5", where the locale has a decimal comma "0,5". Names of files and versions within `text` stay.
QString localised(QString text);

/// The shortest form with at most so many significant digits: 0.1, 1e-5, 123457.
QString number_text(double value, int digits);
/// With so many digits after the decimal mark.
QString fixed_text(double value, int places);
/// A whole number in groups of three digits: "12 345".
QString count_text(double value);

/// A number and its unit with a prefix: "0.909 ms". "%" has none.
QString quantity_text(double value, const std::string& unit, int digits);
/// Simulated time for a reading that changes: always in s with three decimals, or in ms with two where
/// `step`, the distance of two times that are shown, is shorter than a millisecond.
QString time_text(double seconds, double step);
/// A sentence of the engine, in which quantities are written as above.
QString sentence_text(const std::string& sentence);

/// What a person typed into a field of this unit.
cloth::Quantity typed_quantity(const QString& text, const std::string& unit);

}  // namespace clothlab
