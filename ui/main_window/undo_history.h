// The list of all edits that can be undone or done again.
#pragma once

class QUndoStack;
class QWidget;

namespace clothlab {

/// Opens the list beside the window, or brings it forward; a click on an edit goes back or forward to it.
void show_undo_history(QUndoStack& stack, QWidget& window);

}  // namespace clothlab
