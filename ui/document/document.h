// What the windows' documents have in common: a file, the undo history, and whether there is something to
// save.
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
  QString path() const { return path_; }  ///< of the file; empty for one that is built in or was never saved
  virtual QString title() const = 0;      ///< its own, else by the file's name, else "Untitled"
  virtual LabDocument& form() = 0;        ///< the scene that the form edits
  bool isModified() const { return unsaved_ || !undo_stack_.isClean(); }

  /// The document as it is now lies in the file `path`.
  void markSaved(const QString& path);

 Q_SIGNALS:
  void loaded();  ///< the whole content is new; no other signal about it comes with it
  void titleChanged();
  void modifiedChanged(bool modified);

 protected:
  explicit Document(QObject* parent);

  /// Another content was taken over: forgets the history. `unsaved`: it lies in no file yet.
  void beginHistory(const QString& path, bool unsaved);

 private:
  void setUnsaved(bool unsaved);

  QString path_;
  bool unsaved_ = false;
  QUndoStack undo_stack_;
};

}  // namespace clothlab
