#include "theme/theme.h"

#include <QApplication>
#include <QStyleFactory>
#include <optional>

#include "report/palette.h"
#include "theme/follow_desktop.h"
#include "theme/style_sheet.h"

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

Theme make_light() {
  Theme t;
  t.dark = false;
  t.window = "#eef0f4";
  t.panel = "#ffffff";
  t.field = "#ffffff";
  t.text = "#1c2026";
  t.muted_text = "#58606c";
  t.disabled_text = "#878e99";
  t.border = "#d6dae1";
  t.grid_line = "#e7eaee";
  t.accent = "#3457d5";
  t.accent_text = "#ffffff";
  t.warning = "#925500";
  t.error = "#c12f2f";
  t.good = "#1d7a3b";
  t.view_top = "#d9e0ea";
  t.view_bottom = "#f6f8fa";
  t.kinetic = "#0e529c";
  t.elastic = "#e26600";
  t.gravity = "#008858";
  t.total = "#3a3f47";
  t.strain = "#a8457d";
  t.limit = "#bd8040";
  t.step_time = "#2596bd";
  t.draw_time = "#57620f";
  colour_panes(t);
  return t;
}

Theme make_dark() {
  Theme t;
  t.dark = true;
  t.window = "#181a1e";
  t.panel = "#22252b";
  t.field = "#1a1d21";
  t.text = "#e5e8ec";
  t.muted_text = "#a5adb8";
  t.disabled_text = "#79818c";
  t.border = "#383d45";
  t.grid_line = "#31363d";
  t.accent = "#8ea8ff";
  t.accent_text = "#0e1630";
  t.warning = "#f0b349";
  t.error = "#ff7f76";
  t.good = "#5cc980";
  t.view_top = "#2c323b";
  t.view_bottom = "#141619";
  t.kinetic = "#3d87ec";
  t.elastic = "#e17b3c";
  t.gravity = "#2fc49a";
  t.total = "#d9dde3";
  t.strain = "#f07fd2";
  t.limit = "#d9ab18";
  t.step_time = "#48ceff";
  t.draw_time = "#e4f06a";
  colour_panes(t);
  return t;
}

}  // namespace

const Theme& light_theme() {
  static const Theme light = make_light();
  return light;
}

const Theme& dark_theme() {
  static const Theme dark = make_dark();
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
    QApplication::setStyle(QStyleFactory::create("Fusion"));
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

void apply_theme(QApplication& application) {
  const QByteArray wish = qgetenv("CLOTHLAB_THEME").trimmed().toLower();
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
