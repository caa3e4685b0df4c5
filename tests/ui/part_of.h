// Finds the parts of a row of the form by name. The row's message lies beside the row, over the form.
#pragma once

#include <QLabel>
#include <QVariant>

namespace clothlab::test {

template <class Widget>
Widget* part_of(QWidget& root, QWidget& row, const QString& name) {
  if (auto* found = row.findChild<Widget*>(name)) return found;
  for (QLabel* label : root.findChildren<QLabel*>(name))
    if (label->property("row") == row.objectName()) return qobject_cast<Widget*>(label);
  return nullptr;
}

}  // namespace clothlab::test
