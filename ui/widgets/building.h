// Short ways to build bars and forms.
#pragma once

#include <QLayout>
#include <QWidget>

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

}  // namespace clothlab
