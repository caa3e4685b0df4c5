#include "widgets/beside.h"

#include <QCoreApplication>
#include <QEventLoop>
#include <QProgressDialog>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "io/process.h"

namespace clothlab {
namespace {

constexpr std::chrono::milliseconds moment{80};

/// What the thread and the window share.
struct Meeting {
  std::mutex mutex;
  std::condition_variable has_ended;
  bool ended = false;
  QString failure;
  QEventLoop* waiting = nullptr;
};

/// A thread that was stopped and has not ended. The application waits for it at its end.
class LeftThread : public QObject {
 public:
  explicit LeftThread(std::jthread thread) : QObject(qApp), thread_(std::move(thread)) {}

 private:
  std::jthread thread_;
};

void carry_out(const std::function<void(const std::stop_token&)>& work, Meeting& meeting,
               const std::stop_token& stop) {
  QString failure;
  try {
    work(stop);
  } catch (...) {
    failure = QString::fromStdString(cloth::failure_in_hand().text);
  }
  const std::lock_guard lock(meeting.mutex);
  meeting.failure = failure;
  meeting.ended = true;
  meeting.has_ended.notify_all();
  if (meeting.waiting) QMetaObject::invokeMethod(meeting.waiting, &QEventLoop::quit, Qt::QueuedConnection);
}

/// Until the work has ended, or Stop was pressed. Modal: nothing is edited meanwhile.
void wait_with_stop(QWidget* window, const QString& text, QEventLoop& loop) {
  QProgressDialog progress(text, QObject::tr("Stop"), 0, 0, window);
  progress.setObjectName("beside");
  progress.setWindowModality(Qt::WindowModal);
  progress.setMinimumDuration(0);
  QObject::connect(&progress, &QProgressDialog::canceled, &loop, &QEventLoop::quit);
  progress.show();
  loop.exec();
}

}  // namespace

BesideResult beside_the_window(QWidget* window, const QString& text,
                               std::function<void(const std::stop_token& stop)> work) {
  const auto meeting = std::make_shared<Meeting>();
  std::jthread thread(
      [meeting, work = std::move(work)](const std::stop_token& stop) { carry_out(work, *meeting, stop); });
  QEventLoop loop;
  std::unique_lock lock(meeting->mutex);
  if (!meeting->has_ended.wait_for(lock, moment, [&] { return meeting->ended; })) {
    meeting->waiting = &loop;
    lock.unlock();
    wait_with_stop(window, text, loop);
    lock.lock();
    meeting->waiting = nullptr;
  }
  const bool stopped = !meeting->ended;
  const QString failure = meeting->failure;
  lock.unlock();
  if (stopped) {
    thread.request_stop();
    new LeftThread(std::move(thread));
  }
  return {stopped, failure};
}

}  // namespace clothlab
