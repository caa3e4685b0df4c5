// A worker as the window sees it: what is new is fetched at the screen's pace while there is anything to
// fetch, and nothing at all is done while there is not.
#pragma once

#include <QObject>
#include <QTimer>

namespace clothlab {

class WorkerLink : public QObject {
  Q_OBJECT

 protected:
  explicit WorkerLink(QObject* parent);

  /// Something was sent.
  void wake();

  /// Delivers what is new. False: nothing more will come until something is sent.
  virtual bool fetch() = 0;

 private:
  QTimer timer_;
};

}  // namespace clothlab
