#include "main_window/undo_history.h"

#include <QDialog>
#include <QUndoView>
#include <QVBoxLayout>

#include "theme/theme.h"
#include "widgets/building.h"

namespace clothlab {

void show_undo_history(QUndoStack& stack, QWidget& window) {
  auto* dialog = window.findChild<QDialog*>("undoHistory");
  if (!dialog) {
    dialog = named("undoHistory", new QDialog(&window));
    dialog->setWindowTitle(QObject::tr("Undo history"));
    auto* list = named("edits", new QUndoView(&stack, dialog));
    list->setEmptyLabel(QObject::tr("As it was opened"));
    list->setAccessibleName(dialog->windowTitle());
    auto* column = new QVBoxLayout(dialog);
    column->setContentsMargins(spacing, spacing, spacing, spacing);
    column->addWidget(list);
    dialog->resize(320, 400);
  }
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
}

}  // namespace clothlab
