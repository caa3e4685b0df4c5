#include "document/document.h"

namespace clothlab {

Document::Document(QObject* parent) : QObject(parent) {
  connect(&undo_stack_, &QUndoStack::cleanChanged, this, [this] { Q_EMIT modifiedChanged(isModified()); });
}

Document::~Document() {
  // The stack is cleared after this body, when no signal may be sent any more.
  undo_stack_.disconnect(this);
}

void Document::markSaved(const QString& path) {
  path_ = path;
  undo_stack_.setClean();
  setUnsaved(false);
  Q_EMIT titleChanged();
}

void Document::beginHistory(const QString& path, bool unsaved) {
  path_ = path;
  undo_stack_.clear();
  setUnsaved(unsaved);
}

void Document::setUnsaved(bool unsaved) {
  if (unsaved == unsaved_) return;
  unsaved_ = unsaved;
  Q_EMIT modifiedChanged(isModified());
}

}  // namespace clothlab
