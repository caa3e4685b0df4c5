// Above the view: what the mouse does, how the cloth is drawn, from where. Where the window is narrow, the
// last buttons go; what they do is in the menus.
#pragma once

#include <QFrame>

#include "viewport/cloth_view.h"

class QActionGroup;
class QHBoxLayout;
class QMenu;
class QSpinBox;

namespace clothlab {

class ViewBar : public QFrame {
  Q_OBJECT

 public:
  ViewBar(ClothView& view, QAction* save_picture, QWidget* parent = nullptr);

  /// The same choices for the window's menu bar.
  void fillMenu(QMenu& menu) const;

  QSize minimumSizeHint() const override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  QAction* addChoice(QActionGroup* group, const char* icon_name, const QString& text, const QString& tip,
                     const QString& shortcut, const QString& name);
  void addTools(QHBoxLayout& row);
  void addModes(QHBoxLayout& row);
  void addContact(QHBoxLayout& row);
  void addCamera();
  void keepLast(QWidget* button);
  int roomOf(const QWidget& part) const;  ///< px, with the gap before it
  int leastWidth() const;                 ///< px
  void suitWidth();

  ClothView& view_;
  QActionGroup* tools_;
  QActionGroup* modes_;
  QAction* contact_ = nullptr;
  QSpinBox* box_level_ = nullptr;
  QList<QAction*> camera_;
  QList<QWidget*> last_;  ///< those that may go, from left to right: the first to go is the last
  QAction* frame_all_;
};

}  // namespace clothlab
