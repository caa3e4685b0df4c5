#include "widgets/numbers.h"

#include <QLocale>
#include <QRegularExpression>

namespace clothlab {

bool has_decimal_comma() {
  return QLocale().decimalPoint() == ",";
}

QString localised(QString text) {
  static const QRegularExpression decimal(
      QStringLiteral(R"((?<![\w./])(\d+)\.(\d+(e[-+]?\d+)?)(?!\w|\.\w))"));
  return has_decimal_comma() ? text.replace(decimal, QStringLiteral("\\1,\\2")) : text;
}

QString number_text(double value, int digits) {
  return localised(QString::fromStdString(cloth::shown_number(value, digits)));
}

QString fixed_text(double value, int places) {
  return localised(QString::number(value, 'f', places));
}

QString count_text(double value) {
  QString text = QString::number(value, 'f', 0);
  for (qsizetype at = text.size() - 3; at > 0; at -= 3) text.insert(at, QChar(0x202f));  // narrow, no break
  return text;
}

QString quantity_text(double value, const std::string& unit, int digits) {
  return localised(QString::fromStdString(cloth::shown_quantity(value, unit, digits).text()));
}

QString time_text(double seconds, double step) {
  constexpr double millisecond = 1e-3;
  return step < millisecond ? fixed_text(seconds / millisecond, 2) + QStringLiteral(" ms")
                            : fixed_text(seconds, 3) + QStringLiteral(" s");
}

QString sentence_text(const std::string& sentence) {
  static const QRegularExpression quantity(QStringLiteral(
      R"((?<![\w./])(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?) (N s/m|N/m|m/s\^2|m/s|kg|J|N|m|s)(?![\w/^]))"));
  QString text = QString::fromStdString(sentence);
  for (auto found = quantity.match(text); found.hasMatch();) {
    const QString shown =
        quantity_text(found.captured(1).toDouble(), found.captured(2).toStdString(), cloth::all_digits);
    text.replace(found.capturedStart(), found.capturedLength(), shown);
    found = quantity.match(text, found.capturedStart() + shown.size());
  }
  return localised(text);
}

cloth::Quantity typed_quantity(const QString& text, const std::string& unit) {
  return cloth::quantity_from(text.trimmed().toStdString(), unit, has_decimal_comma());
}

}  // namespace clothlab
