// Short ways to build bars and forms.
#pragma once

#include <QAction>
#include <QLayout>
#include <QToolButton>

namespace clothlab {

/// Tests find a part by its name.
template <class Part>
Part* named(const QString& name, Part* part) {
  part->setObjectName(name);
  return part;
}

/// Text in the quieter colour.
template <class Label>
Label* muted(Label* label) {
  label->setProperty("muted", true);
  return label;
}

/// `gap` in px between its parts, and so many px around them.
template <class Layout>
Layout* spaced(Layout* layout, int gap, QMargins around = {}) {
  layout->setContentsMargins(around);
  layout->setSpacing(gap);
  return layout;
}

/// How a bar shows an action.
inline QToolButton* make_action_button(QAction* action, QWidget* parent) {
  auto* button = named(action->objectName() + "Button", new QToolButton(parent));
  button->setDefaultAction(action);
  button->setAutoRaise(true);
  button->setIconSize({20, 20});
  button->setAccessibleName(action->text());
  return button;
}

}  // namespace clothlab
