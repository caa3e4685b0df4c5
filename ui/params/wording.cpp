#include "params/wording.h"

#include <QStringList>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "integrators/registry.h"

namespace clothlab {

using cloth::Kind;

QString unit_text(const std::string& unit) {
  QString text = QString::fromStdString(unit);
  text.replace("^2", QStringLiteral("²"))
      .replace("^3", QStringLiteral("³"))
      .replace(' ', QStringLiteral("·"));
  return text;
}

QString typographic(const QString& text) {
  QString shown = text;
  shown.replace(">=", QStringLiteral("≥"))
      .replace("<=", QStringLiteral("≤"))
      .replace("->", QStringLiteral("→"));
  return shown;
}

QString choice_text(const std::string& word) {
  static const std::map<std::string, QString> named{{"coulomb", "Coulomb friction"},
                                                    {"reflect", "Reflection, Eq. (17)"}};
  if (const auto found = named.find(word); found != named.end()) return found->second;
  for (const cloth::MethodFacts& method : cloth::integrator_facts())
    if (method.name == word) return QString::fromStdString(method.title);
  QString text = QString::fromStdString(word).replace('-', ' ').replace('_', ' ');
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text;
}

QString words_text(const cloth::Words& words) {
  if (words.empty()) return QStringLiteral("None");
  QStringList parts;
  for (const std::string& word : words) parts << QString::fromStdString(word);
  const QString last = parts.takeLast();
  QString text = parts.isEmpty() ? last : parts.join(", ") + " and " + last;
  text[0] = text[0].toUpper();
  return text;
}

namespace {

struct InWords {
  QString operator()(double value) const { return exact_text(value); }
  QString operator()(std::int64_t value) const { return QString::number(value); }
  QString operator()(const cloth::Vec3& v) const {
    return QString("(%1, %2, %3)").arg(exact_text(v.x()), exact_text(v.y()), exact_text(v.z()));
  }
  QString operator()(const std::string& word) const {
    return kind == Kind::choice ? choice_text(word) : QString::fromStdString(word);
  }
  QString operator()(const cloth::Words& words) const { return words_text(words); }

  Kind kind;
};

QString range_in_words(const cloth::ParameterInfo& info) {
  const bool numeric = info.kind == Kind::number || info.kind == Kind::integer || info.kind == Kind::vector;
  if (!numeric) return {};
  if (info.unit_vector) return QStringLiteral("any direction");
  return typographic(QString::fromStdString(range_text(info))) +
         (info.auto_allowed ? QStringLiteral(", or auto") : QString());
}

QString row(const QString& name, const QString& value) {
  if (value.isEmpty()) return {};
  return QString("<tr><td style='padding-right:12px'>%1</td><td>%2</td></tr>")
      .arg(name, value.toHtmlEscaped());
}

/// "1e-05" -> "1e-5", "1e+20" -> "1e20"
QString with_short_exponent(const char* begin, const char* end) {
  QString text = QString::fromLatin1(begin, end - begin);
  const qsizetype mark = text.indexOf('e');
  if (mark < 0) return text;
  QString exponent = text.mid(mark + 1);
  const bool negative = exponent.startsWith('-');
  if (negative || exponent.startsWith('+')) exponent.remove(0, 1);
  while (exponent.size() > 1 && exponent.startsWith('0')) exponent.remove(0, 1);
  return text.left(mark + 1) + (negative ? "-" : "") + exponent;
}

}  // namespace

QString value_in_words(const cloth::ParameterInfo& info, const cloth::ParameterValue& value) {
  const QString text = std::visit(InWords{info.kind}, value);
  const bool has_unit = !info.unit.empty() && !std::holds_alternative<std::string>(value);
  return has_unit ? text + ' ' + unit_text(info.unit) : text;
}

QString tooltip_of(const cloth::Parameter& parameter, const std::optional<cloth::ParameterValue>& fallback) {
  const cloth::ParameterInfo& info = parameter.info;
  const auto escaped = [](const std::string& text) { return QString::fromStdString(text).toHtmlEscaped(); };
  QString text = QString("<p><b>%1</b><br>%2</p>").arg(escaped(info.label), escaped(info.doc));
  if (!info.formula.empty()) text += QString("<p><code>%1</code></p>").arg(escaped(info.formula));
  text += "<table cellspacing='0' cellpadding='0' style='margin-top:6px'>";
  text += row("Range", range_in_words(info));
  if (fallback) text += row("Default", value_in_words(info, *fallback));
  text += row("Unit", unit_text(info.unit));
  if (info.cost == cloth::EditCost::restart) text += row("An edit", "restarts the simulation");
  text += row("Path", QString::fromStdString(parameter.path));
  return text + "</table>";
}

QString short_text(double value) {
  std::array<char, 40> buffer;
  const auto result = std::to_chars(buffer.begin(), buffer.end(), value, std::chars_format::general, 6);
  return with_short_exponent(buffer.begin(), result.ptr);
}

QString exact_text(double value) {
  std::array<char, 40> buffer;
  const auto result = std::to_chars(buffer.begin(), buffer.end(), value);
  return with_short_exponent(buffer.begin(), result.ptr);
}

std::optional<double> number_from(const QString& text, const QString& unit) {
  QString bare = text.trimmed();
  if (!unit.isEmpty() && bare.endsWith(unit)) bare = bare.chopped(unit.size()).trimmed();
  bare.replace(QChar(0x2212), '-');  // the typographic minus, as it comes out of papers
  if (bare.startsWith('+') && !bare.startsWith("+-")) bare.remove(0, 1);
  const std::string ascii = bare.toStdString();
  double value = 0;
  const auto [stop, error] = std::from_chars(ascii.data(), ascii.data() + ascii.size(), value);
  if (error != std::errc() || stop != ascii.data() + ascii.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace clothlab
