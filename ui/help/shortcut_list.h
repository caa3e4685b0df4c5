// The keys of a window, read from its actions.
#pragma once

#include <QString>

class QMainWindow;

namespace clothlab {

/// As HTML: for each menu a table of its entries that have keys, those of its submenus too.
QString shortcut_page(const QMainWindow& window);

}  // namespace clothlab
