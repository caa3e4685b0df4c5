// Above the view: what the mouse does, how the cloth is drawn, from where.
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

 private:
  QAction* addChoice(QActionGroup* group, const char* icon_name, const QString& text, const QString& tip,
                     const QString& shortcut, const QString& name);
  void addTools(QHBoxLayout& row);
  void addModes(QHBoxLayout& row);
  void addContact(QHBoxLayout& row);
  void addCamera(QHBoxLayout& row);

  ClothView& view_;
  QActionGroup* tools_;
  QActionGroup* modes_;
  QAction* contact_ = nullptr;
  QSpinBox* box_level_ = nullptr;
  QList<QAction*> camera_;
  QAction* frame_all_;
};

}  // namespace clothlab
