
#include <QFile>
#include <QHash>
#include <QRegularExpression>

#include "theme/theme.h"

// Q_INIT_RESOURCE declares a function of the global namespace and so cannot stand inside ours.
static void init_theme_resources() {
  Q_INIT_RESOURCE(clothlab_theme);
}

namespace clothlab {

void ensure_resources() {
  static const bool done = (init_theme_resources(), true);
  Q_UNUSED(done);
}

QColor blend(const QColor& under, const QColor& over, qreal part) {
  const auto mix = [part](float a, float b) { return a + static_cast<float>(part) * (b - a); };
  return QColor::fromRgbF(mix(under.redF(), over.redF()), mix(under.greenF(), over.greenF()),
                          mix(under.blueF(), over.blueF()));
}

QString style_sheet(const Theme& t) {
  ensure_resources();
  QFile file(":/clothlab/themes/clothlab.qss");
  if (!file.open(QIODevice::ReadOnly)) {
    qWarning("the style sheet is missing from the program's resources");
    return {};
  }
  const QString pattern = QString::fromUtf8(file.readAll());

  const QString shade = t.dark ? "dark" : "light";
  const QHash<QString, QString> values = {
      {"window", t.window.name()},
      {"panel", t.panel.name()},
      {"field", t.field.name()},
      {"text", t.text.name()},
      {"muted_text", t.muted_text.name()},
      {"disabled_text", t.disabled_text.name()},
      {"border", t.border.name()},
      {"accent", t.accent.name()},
      {"accent_text", t.accent_text.name()},
      {"warning", t.warning.name()},
      {"error", t.error.name()},
      {"good", t.good.name()},
      // Steps between two of the colours: what a control shows under the pointer, pressed, or switched on.
      {"outline", blend(t.border, t.muted_text, t.dark ? 0.40 : 0.45).name()},
      {"hover", blend(t.panel, t.text, 0.07).name()},
      {"pressed", blend(t.panel, t.text, 0.13).name()},
      {"bar_hover", blend(t.window, t.text, 0.08).name()},
      {"bar_pressed", blend(t.window, t.text, 0.14).name()},
      {"checked", blend(t.window, t.accent, t.dark ? 0.24 : 0.16).name()},
      {"checked_border", blend(t.window, t.accent, 0.45).name()},
      {"selection", blend(t.panel, t.accent, t.dark ? 0.24 : 0.14).name()},
      {"groove", blend(t.panel, t.text, t.dark ? 0.20 : 0.16).name()},
      {"knob", t.dark ? t.text.name() : t.panel.name()},
      {"knob_disabled", blend(t.panel, t.disabled_text, 0.55).name()},
      {"scroll", blend(t.panel, t.text, 0.24).name()},
      {"scroll_hover", blend(t.panel, t.text, 0.42).name()},
      {"accent_hover", blend(t.accent, t.text, t.dark ? 0.22 : 0.16).name()},
      {"accent_pressed", blend(t.accent, t.dark ? t.panel : t.text, 0.28).name()},
      {"shade", shade},
  };

  static const QRegularExpression name("@([a-z_]+)");
  QString sheet;
  sheet.reserve(pattern.size() + 1024);
  qsizetype end = 0;
  for (auto it = name.globalMatch(pattern); it.hasNext();) {
    const auto match = it.next();
    sheet += QStringView(pattern).mid(end, match.capturedStart() - end);
    Q_ASSERT(values.contains(match.captured(1)));
    sheet += values.value(match.captured(1));
    end = match.capturedEnd();
  }
  sheet += QStringView(pattern).mid(end);
  return sheet;
}

}  // namespace clothlab
