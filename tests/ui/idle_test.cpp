// A window in which nothing moves does nothing.
#include <QElapsedTimer>

#include "listed_test.h"
#include "window_bench.h"

namespace clothlab::test::idle_test {
namespace {

/// Since when no timer has fired and nothing has been painted, in any widget of the program.
class Quiet : public QObject {
 public:
  Quiet() {
    qApp->installEventFilter(this);
    since_.start();
  }
  bool eventFilter(QObject* watched, QEvent* event) override {
    const QEvent::Type type = event->type();
    if (type == QEvent::Timer || type == QEvent::Paint || type == QEvent::UpdateRequest) {
      since_.restart();
      last_ = QString("event %1 to %2").arg(type).arg(watched->metaObject()->className());
    }
    return false;
  }
  qint64 milliseconds() const { return since_.elapsed(); }
  const QString& last() const { return last_; }

 private:
  QElapsedTimer since_;
  QString last_;
};

constexpr int quiet_ms = 2000, patience_ms = 60000;

/// However slow the machine: sooner or later there are two seconds without an event. What goes on at some
/// rate never gives them.
#define VERIFY_FALLS_QUIET()                                                                     \
  do {                                                                                           \
    Quiet quiet;                                                                                 \
    for (int waited = 0; quiet.milliseconds() < quiet_ms && waited < patience_ms; waited += 100) \
      QTest::qWait(100);                                                                         \
    QVERIFY2(quiet.milliseconds() >= quiet_ms, qPrintable(quiet.last()));                        \
  } while (false)

}  // namespace

class IdleTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
  }

  void a_window_that_was_opened_paused_does_nothing() {
    WindowBench bench;
    VERIFY_FALLS_QUIET();
  }

  void a_window_that_was_paused_does_nothing() {
    WindowBench bench("wind");
    bench.window.view().setMode(ViewMode::strain);
    bench.play_until(0.1);
    bench.pause();
    VERIFY_FALLS_QUIET();
  }

  void one_change_is_not_drawn_over_and_over() {
    WindowBench bench;
    VERIFY_FALLS_QUIET();
    QSignalSpy drawn(&bench.window.view(), &ClothView::frameDrawn);
    bench.window.view().setMode(ViewMode::wireframe);
    VERIFY_FALLS_QUIET();
    QVERIFY2(drawn.count() >= 1 && drawn.count() <= 3, qPrintable(QString::number(drawn.count())));
  }
};

const Listed listed{"idle_test", test_main<IdleTest>};

}  // namespace clothlab::test::idle_test

#include "idle_test.moc"
