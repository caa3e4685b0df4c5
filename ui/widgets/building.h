// Helper functions that build bars and forms.
#pragma once

#include <QAction>
#include <QLayout>
#include <QToolButton>

namespace clothlab {

/// Sets the object name, by which tests and style sheets find the part.
template <class Part>
Part* named(const QString& name, Part* part) {
  part->setObjectName(name);
  return part;
}

/// Shows the label's text in the theme's muted colour.
template <class Label>
Label* muted(Label* label) {
  label->setProperty("muted", true);
  return label;
}

/// Sets the spacing between the layout's parts and its margins (px).
template <class Layout>
Layout* spaced(Layout* layout, int gap, QMargins around = {}) {
  layout->setContentsMargins(around);
  layout->setSpacing(gap);
  return layout;
}

/// A widget with this dynamic property set to true has a use of its own for arrow keys, Home and End; from
/// other widgets they move the timeline.
inline constexpr const char* keeps_arrow_keys = "keepsArrowKeys";

/// A flat tool button for an action in a bar.
inline QToolButton* make_action_button(QAction* action, QWidget* parent) {
  auto* button = named(action->objectName() + "Button", new QToolButton(parent));
  button->setDefaultAction(action);
  button->setAutoRaise(true);
  button->setIconSize({20, 20});
  button->setAccessibleName(action->text());
  return button;
}

}  // namespace clothlab
