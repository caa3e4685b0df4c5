// The theme: a light and a dark set of colours, chosen as the desktop's, with one accent colour and one
// spacing unit.
#pragma once

#include <QColor>
#include <QIcon>
#include <QPalette>
#include <QString>

class QApplication;

namespace clothlab {

struct Theme {
  bool dark = false;
  QColor window, panel, field;  ///< surfaces, from back to front
  QColor text, muted_text, disabled_text;
  QColor border, grid_line;
  QColor accent, accent_text;    ///< the one accent, and text on it
  QColor warning, error, good;   ///< states: gauge, messages
  QColor view_top, view_bottom;  ///< background gradient behind the cloth
  /// Curves, colour-blind safe (Okabe and Ito 2008, adjusted for contrast with the panel).
  QColor kinetic, elastic, gravity, total, strain, limit, step_time, draw_time;
  QColor pane_a, pane_b, pane_c, pane_d;  ///< of a comparison: the colours of its reports and plots
};

/// The set for the application's present palette (or for an explicit choice).
const Theme& theme();
const Theme& light_theme();
const Theme& dark_theme();

/// Fusion style, palette and style sheet. Follows the desktop: dark when the desktop's window colour is dark,
/// unless the environment variable CLOTHLAB_THEME or else the user's choice says "light" or "dark".
void apply_theme(QApplication& application);
void apply_theme(QApplication& application, bool dark);

/// The user's choice, which is kept in QSettings: "light", "dark", or empty for that of the desktop.
QString chosen_theme();
void choose_theme(QApplication& application, const QString& choice);

QPalette palette_for(const Theme& theme);

/// One of our own icons from resources/icons by its base name ("play"), tinted with the theme's text colour
/// (normal), accent (checked) and disabled colour.
QIcon icon(const QString& name);

/// The same for a button whose background is the accent.
QIcon icon_on_accent(const QString& name);

inline constexpr int spacing = 8;  ///< px: every margin and gap is a multiple of half of it

/// The style sheet resources/themes/clothlab.qss with one theme's colours filled in.
QString style_sheet(const Theme& theme);

/// `part` of `over` laid on `under`: 0 gives `under`, 1 gives `over`.
QColor blend(const QColor& under, const QColor& over, qreal part);

/// Registers the resources. The linker drops the resources of a static library that no code refers to, so the
/// style sheet and the icons call this first.
void ensure_resources();

}  // namespace clothlab
