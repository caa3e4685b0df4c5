// The base of the windows' documents: file path, undo history and unsaved changes. Used by the GUI thread
// only.
#pragma once

#include <QObject>
#include <QString>
#include <QUndoStack>

namespace clothlab {

class LabDocument;

class Document : public QObject {
  Q_OBJECT

 public:
  ~Document() override;

  QUndoStack& undoStack() { return undo_stack_; }
  const QUndoStack& undoStack() const { return undo_stack_; }
  QString path() const {
    return path_;
  }  ///< of the file; empty for a built-in document or one that was never saved
  virtual QString title() const = 0;  ///< the document's title, else the file's name, else "Untitled"
  virtual LabDocument& form() = 0;    ///< the scene that the form edits
  bool isModified() const { return unsaved_ || !undo_stack_.isClean(); }

  /// Records that the file `path` contains the document as it is now.
  void markSaved(const QString& path);

 Q_SIGNALS:
  void loaded();  ///< the whole content was replaced; no other signal is emitted for it
  void titleChanged();
  void modifiedChanged(bool modified);

 protected:
  explicit Document(QObject* parent);

  /// Called after the content was replaced: clears the undo history. `unsaved`: no file contains it yet.
  void beginHistory(const QString& path, bool unsaved);

 private:
  void setUnsaved(bool unsaved);

  QString path_;
  bool unsaved_ = false;
  QUndoStack undo_stack_;
};

}  // namespace clothlab
