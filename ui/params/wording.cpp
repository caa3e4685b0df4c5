#include "params/wording.h"

#include <QStringList>
#include <map>
#include <string>

#include "integrators/registry.h"
#include "widgets/numbers.h"

namespace clothlab {

using cloth::Kind;

QString unit_text(const std::string& unit) {
  return QString::fromStdString(cloth::shown_unit(unit));
}

QString typographic(const QString& text) {
  QString shown = text;
  shown.replace(">=", QStringLiteral("≥"))
      .replace("<=", QStringLiteral("≤"))
      .replace("->", QStringLiteral("→"));
  return localised(shown);
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
  QString operator()(double value) const { return quantity_text(value, info.unit, cloth::all_digits); }
  QString operator()(std::int64_t value) const { return with_unit(QString::number(value)); }
  QString operator()(const cloth::Vec3& v) const {
    QStringList parts;
    for (const double part : v) parts << number_text(part, cloth::all_digits);
    return with_unit('(' + parts.join(has_decimal_comma() ? "; " : ", ") + ')');
  }
  QString operator()(const std::string& word) const {
    return info.kind == Kind::choice ? choice_text(word) : QString::fromStdString(word);
  }
  QString operator()(const cloth::Words& words) const { return words_text(words); }

  QString with_unit(const QString& text) const {
    return info.unit.empty() ? text : text + ' ' + unit_text(info.unit);
  }

  const cloth::ParameterInfo& info;
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

}  // namespace

QString value_in_words(const cloth::ParameterInfo& info, const cloth::ParameterValue& value) {
  return std::visit(InWords{info}, value);
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

}  // namespace clothlab
