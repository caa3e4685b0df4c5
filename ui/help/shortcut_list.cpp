#include "help/shortcut_list.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QRegularExpression>

namespace clothlab {
namespace {

/// Without the mark of the menu's own key and the dots of an entry that asks on.
QString plain(QString text) {
  return text.remove('&').remove(QStringLiteral("…"));
}

/// Without the keys, which stand beside it.
QString tip_of(const QAction& action) {
  static const QRegularExpression keys(QStringLiteral(R"( \([^()]*\)$)"));
  const QString tip = action.toolTip().remove(keys);
  return plain(tip) == plain(action.text()) ? QString() : tip;
}

QString rows_of(const QMenu& menu) {
  QString rows;
  for (const QAction* action : menu.actions()) {
    if (action->menu()) {
      rows += rows_of(*action->menu());
      continue;
    }
    const QString keys = QKeySequence::listToString(action->shortcuts(), QKeySequence::NativeText);
    if (keys.isEmpty()) continue;
    rows += QStringLiteral("<tr><td width='150'><b>%1</b></td><td width='170'>%2</td><td>%3</td></tr>")
                .arg(keys.toHtmlEscaped(), plain(action->text()).toHtmlEscaped(),
                     tip_of(*action).toHtmlEscaped());
  }
  return rows;
}

}  // namespace

QString shortcut_page(const QMainWindow& window) {
  QString page = QObject::tr(
      "<h1>Shortcuts</h1><p>Keys and mouse in the view, on the timeline and in the charts: see the "
      "<a href='guide.md#the-view'>guide</a>.</p>");
  for (const QAction* entry : window.menuBar()->actions()) {
    const QString rows = entry->menu() ? rows_of(*entry->menu()) : QString();
    if (rows.isEmpty()) continue;
    page += QStringLiteral(
                "<p style='margin:0'>&nbsp;</p><h2>%1</h2><table cellspacing='0' cellpadding='3'>%2</table>")
                .arg(plain(entry->text()).toHtmlEscaped(), rows);
  }
  return page;
}

}  // namespace clothlab
