// Saves a document with unsaved changes aside every half minute, so that it can be restored after a crash.
#pragma once

#include <QLockFile>
#include <QObject>
#include <QTimer>
#include <memory>
#include <vector>

namespace clothlab {

class LabDocument;

/// A file that a process left when it ended. As long as a copy of this lives no other program finds the file.
struct LeftFile {
  QString path;
  std::shared_ptr<QLockFile> lock;
};

class Autosave : public QObject {
  Q_OBJECT

 public:
  /// The document must outlive it.
  explicit Autosave(LabDocument& document, QObject* parent = nullptr);
  /// Saves the changes aside now, as before the process ends by a signal.
  void save();
  /// Deletes the file: the changes were saved or discarded.
  void forget();

  void setInterval(int milliseconds) { timer_.setInterval(milliseconds); }
  QString file() const { return file_; }  ///< empty: nothing is kept

  /// Files of processes that have ended without deleting them, the oldest first.
  static std::vector<LeftFile> found();
  static QString folder();

 Q_SIGNALS:
  void failed(const QString& problem);  ///< once, until it works again

 private:
  LabDocument& document_;
  QTimer timer_;
  std::unique_ptr<QLockFile> lock_;  ///< held while there is a file: it is not a dead process's
  QString file_;
  bool has_failed_ = false;
};

}  // namespace clothlab
