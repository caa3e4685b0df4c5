#include "theme/theme.h"

#include <QApplication>
#include <QSettings>
#include <optional>

#include "report/palette.h"
#include "theme/follow_desktop.h"
#include "theme/lab_style.h"

namespace clothlab {
namespace {

/// The set that apply_theme() chose; null before its first call.
const Theme* chosen = nullptr;

bool is_dark(const QPalette& palette) {
  return palette.color(QPalette::Window).lightnessF() < palette.color(QPalette::WindowText).lightnessF();
}

/// What the desktop itself would show. Where it does not say so, its palette tells, and that is hidden by
/// ours once it is set: an empty palette uncovers it again.
bool desktop_is_dark() {
  if (const std::optional<bool> preference = portal_prefers_dark()) return *preference;
  QApplication::setPalette(QPalette());
  return is_dark(QApplication::palette());
}

void colour_panes(Theme& t) {
  int series = 0;
  for (QColor* colour : {&t.pane_a, &t.pane_b, &t.pane_c, &t.pane_d}) {
    const cloth::PageColour own = cloth::style_of_series(series++).colour;
    *colour = QColor(QString::fromStdString(t.dark ? own.dark : own.light));
  }
}

struct ThemeColour {
  QColor Theme::*role;
  const char *light, *dark;
};

constexpr ThemeColour theme_colours[] = {
    {&Theme::window, "#eef0f4", "#181a1e"},      {&Theme::panel, "#ffffff", "#22252b"},
    {&Theme::field, "#ffffff", "#1a1d21"},       {&Theme::text, "#1c2026", "#e5e8ec"},
    {&Theme::muted_text, "#58606c", "#a5adb8"},  {&Theme::disabled_text, "#878e99", "#79818c"},
    {&Theme::border, "#d6dae1", "#383d45"},      {&Theme::grid_line, "#e7eaee", "#31363d"},
    {&Theme::accent, "#3457d5", "#8ea8ff"},      {&Theme::accent_text, "#ffffff", "#0e1630"},
    {&Theme::warning, "#925500", "#f0b349"},     {&Theme::error, "#c12f2f", "#ff7f76"},
    {&Theme::good, "#1d7a3b", "#5cc980"},        {&Theme::view_top, "#d9e0ea", "#2c323b"},
    {&Theme::view_bottom, "#f6f8fa", "#141619"}, {&Theme::kinetic, "#0e529c", "#3d87ec"},
    {&Theme::elastic, "#e26600", "#e17b3c"},     {&Theme::gravity, "#008858", "#2fc49a"},
    {&Theme::total, "#3a3f47", "#d9dde3"},       {&Theme::strain, "#a8457d", "#f07fd2"},
    {&Theme::limit, "#bd8040", "#d9ab18"},       {&Theme::step_time, "#2596bd", "#48ceff"},
    {&Theme::draw_time, "#57620f", "#e4f06a"},
};

Theme make_theme(bool dark) {
  Theme t;
  t.dark = dark;
  for (const ThemeColour& colour : theme_colours) t.*colour.role = QColor(dark ? colour.dark : colour.light);
  colour_panes(t);
  return t;
}

}  // namespace

const Theme& light_theme() {
  static const Theme light = make_theme(false);
  return light;
}

const Theme& dark_theme() {
  static const Theme dark = make_theme(true);
  return dark;
}

const Theme& theme() {
  if (chosen) return *chosen;
  return qApp && is_dark(QApplication::palette()) ? dark_theme() : light_theme();
}

QPalette palette_for(const Theme& t) {
  QPalette palette;
  const auto set = [&palette](QPalette::ColorRole role, const QColor& enabled, const QColor& disabled) {
    palette.setColor(QPalette::Active, role, enabled);
    palette.setColor(QPalette::Inactive, role, enabled);
    palette.setColor(QPalette::Disabled, role, disabled);
  };
  set(QPalette::Window, t.window, t.window);
  set(QPalette::WindowText, t.text, t.disabled_text);
  set(QPalette::Base, t.field, t.window);
  set(QPalette::AlternateBase, t.window, t.window);
  set(QPalette::Text, t.text, t.disabled_text);
  set(QPalette::PlaceholderText, t.muted_text, t.disabled_text);
  set(QPalette::Button, t.panel, t.window);
  set(QPalette::ButtonText, t.text, t.disabled_text);
  set(QPalette::BrightText, t.error, t.disabled_text);
  set(QPalette::ToolTipBase, t.panel, t.panel);
  set(QPalette::ToolTipText, t.text, t.text);
  set(QPalette::Highlight, t.accent, t.border);
  set(QPalette::HighlightedText, t.accent_text, t.disabled_text);
  set(QPalette::Link, t.accent, t.disabled_text);
  set(QPalette::LinkVisited, t.accent, t.disabled_text);
  // The bevel roles, from the light edge to the shadow: Fusion draws frames and gradients with them.
  set(QPalette::Light, t.dark ? t.border.lighter(120) : t.panel, t.panel);
  set(QPalette::Midlight, t.dark ? t.border : t.grid_line, t.grid_line);
  set(QPalette::Mid, t.border, t.border);
  set(QPalette::Dark, t.dark ? t.window.darker(130) : t.border.darker(120), t.border);
  set(QPalette::Shadow, t.dark ? QColor(Qt::black) : t.border.darker(150), t.border);
  return palette;
}

namespace {

void show_theme(QApplication& application, const Theme& t) {
  chosen = &t;
  // A style sheet wraps the style, which then no longer shows whether it is Fusion: so that is remembered.
  if (!application.property("clothlab_styled").toBool()) {
    QApplication::setStyle(new LabStyle);
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);  // they follow the desktop, not our theme
    application.setProperty("clothlab_styled", true);
  }
  QApplication::setPalette(palette_for(t));
  application.setStyleSheet(style_sheet(t));
}

}  // namespace

void apply_theme(QApplication& application, bool dark) {
  // An explicit choice stands whatever the desktop does later.
  delete application.findChild<FollowDesktop*>(QString(), Qt::FindDirectChildrenOnly);
  show_theme(application, dark ? dark_theme() : light_theme());
}

QString chosen_theme() {
  return QSettings().value("theme").toString();
}

void choose_theme(QApplication& application, const QString& choice) {
  QSettings().setValue("theme", choice);
  apply_theme(application);
}

void apply_theme(QApplication& application) {
  QString wish = qEnvironmentVariable("CLOTHLAB_THEME").trimmed().toLower();
  if (wish.isEmpty()) wish = chosen_theme();
  if (wish == "dark" || wish == "light") {
    apply_theme(application, wish == "dark");
    return;
  }
  show_theme(application, desktop_is_dark() ? dark_theme() : light_theme());
  // Owned by the application, and only one of them however often this is called.
  if (!application.findChild<FollowDesktop*>(QString(), Qt::FindDirectChildrenOnly))
    new FollowDesktop(application);
}

}  // namespace clothlab
