// What every window with a document has: undo and redo, and the question before changes are lost.
#pragma once

#include <functional>

class QAction;
class QString;
class QUndoStack;
class QWidget;

namespace clothlab {

struct UndoActions {
  QAction* undo;
  QAction* redo;
};

/// With names, icons and keys; they belong to `window`.
UndoActions make_undo_actions(QUndoStack& stack, QWidget* window);

/// Save, discard or cancel: whether to go on. Saves by `save`, which says whether it did.
bool ask_to_save(QWidget* window, const QString& question, const std::function<bool()>& save);

}  // namespace clothlab
