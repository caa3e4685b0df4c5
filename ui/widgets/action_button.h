// How the window's bars show an action as a button.
#pragma once

#include <QAction>
#include <QToolButton>

namespace clothlab {

inline QToolButton* make_action_button(QAction* action, QWidget* parent) {
  auto* button = new QToolButton(parent);
  button->setDefaultAction(action);
  button->setAutoRaise(true);
  button->setIconSize({20, 20});
  button->setObjectName(action->objectName() + "Button");
  button->setAccessibleName(action->text());
  return button;
}

}  // namespace clothlab
