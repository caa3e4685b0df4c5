#include "document/document_actions.h"

#include <QAction>
#include <QMessageBox>
#include <QUndoStack>
#include <QWidget>

#include "theme/theme.h"

namespace clothlab {

UndoActions make_undo_actions(QUndoStack& stack, QWidget* window) {
  QAction* undo = stack.createUndoAction(window, QObject::tr("Undo"));
  undo->setObjectName("undo");
  undo->setIcon(icon("undo"));
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = stack.createRedoAction(window, QObject::tr("Redo"));
  redo->setObjectName("redo");
  redo->setIcon(icon("redo"));
  redo->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  return {undo, redo};
}

bool ask_to_save(QWidget* window, const QString& question, const std::function<bool()>& save) {
  const auto answer = QMessageBox::question(window, QObject::tr("Unsaved changes"), question,
                                            QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel,
                                            QMessageBox::Save);
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save());
}

}  // namespace clothlab
