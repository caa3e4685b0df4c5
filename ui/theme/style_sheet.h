// The style sheet resources/themes/clothlab.qss with one theme's colours filled in.
#pragma once

#include <QColor>
#include <QString>

namespace clothlab {

struct Theme;

QString style_sheet(const Theme& theme);

/// `part` of `over` laid on `under`: 0 gives `under`, 1 gives `over`.
QColor blend(const QColor& under, const QColor& over, qreal part);

/// A static library's resources are dropped by the linker unless somebody asks for them; both the style sheet
/// and the icons ask here.
void ensure_resources();

}  // namespace clothlab
