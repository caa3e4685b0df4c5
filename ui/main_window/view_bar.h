// The bar above the view: mouse tool, view mode, contact display and camera. In a narrow window the last
// buttons are hidden; their actions remain in the menus.
#pragma once

#include <QAction>
#include <QActionGroup>
#include <QFrame>
#include <vector>

#include "compare/pane_grid.h"

class QComboBox;
class QHBoxLayout;
class QMenu;
class QSpinBox;
class QToolButton;

namespace clothlab {

/// One of several exclusive choices, shown in a bar and in a menu.
template <class Value>
struct ViewChoice {
  Value value;
  const char* icon;
  QString text, tip, shortcut;
  const char* name;
};

/// An action whose tooltip contains the shortcut.
QAction* make_view_action(const char* icon_name, const QString& text, const QString& tip,
                          const QString& shortcut, const char* name, QObject* parent);

/// An exclusive group of checkable actions; the first one is checked initially. A triggered action calls
/// `choose` with its value.
template <class Value, class Choose>
QActionGroup* make_choices(QObject* parent, const std::vector<ViewChoice<Value>>& choices, Choose choose) {
  auto* group = new QActionGroup(parent);
  for (const ViewChoice<Value>& entry : choices) {
    QAction* action = make_view_action(entry.icon, entry.text, entry.tip, entry.shortcut, entry.name, group);
    action->setCheckable(true);
    QObject::connect(action, &QAction::triggered, parent, [choose, value = entry.value] { choose(value); });
  }
  group->actions().constFirst()->setChecked(true);
  return group;
}

class ViewBar : public QFrame {
  Q_OBJECT

 public:
  /// `panes` must outlive the bar.
  ViewBar(PaneGrid& panes, QAction* save_picture, QWidget* parent = nullptr);

  /// Adds the same choices to a menu of the window's menu bar.
  void fillMenu(QMenu& menu) const;

  /// Only a comparison has differences to show.
  void showComparison(bool on);

  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void addTools();
  void addModes();
  void addProbes(QHBoxLayout& row);
  void addContact(QHBoxLayout& row);
  void addCamera();
  QToolButton* makeCameraButton();
  void keepLast(QWidget* button);
  int roomOf(const QWidget& part) const;  ///< px, with the gap before it
  int leastWidth() const;                 ///< px
  void suitWidth();

  PaneGrid& panes_;
  QActionGroup *tools_ = nullptr, *modes_ = nullptr;
  QWidget* difference_ = nullptr;       ///< the button of that mode
  QComboBox* probe_measure_ = nullptr;  ///< there while the tool is
  QAction* contact_ = nullptr;
  QSpinBox* box_level_ = nullptr;
  QList<QAction*> camera_;
  QList<QWidget*> last_;  ///< the buttons that may be hidden, from left to right; the last is hidden first
  QAction* frame_all_ = nullptr;
};

}  // namespace clothlab
