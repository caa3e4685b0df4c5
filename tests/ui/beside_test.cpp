// Long work goes on beside the window, can be stopped, and ends in a message where it fails.
#include "widgets/beside.h"

#include <QProgressDialog>
#include <QPushButton>
#include <QTemporaryDir>
#include <latch>
#include <new>
#include <semaphore>
#include <tuple>

#include "listed_test.h"
#include "patience.h"
#include "window_bench.h"

namespace clothlab::test::beside_test {
namespace {

QProgressDialog* progress_of(const QWidget& window) {
  auto* progress = window.findChild<QProgressDialog*>("beside");
  return progress && progress->isVisible() ? progress : nullptr;
}

/// An OBJ file of so many vertices per side: reading it takes some while.
QByteArray sheet_of(int side) {
  QByteArray text;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      text += QByteArray("v %1 0 %2\n")
                  .replace("%1", QByteArray::number(0.01 * column))
                  .replace("%2", QByteArray::number(0.01 * row));
  for (int row = 0; row + 1 < side; ++row)
    for (int column = 1; column < side; ++column) {
      const int corner = row * side + column;
      for (const auto& [a, b, c] : {std::tuple(corner, corner + 1, corner + side),
                                    std::tuple(corner + 1, corner + side + 1, corner + side)})
        text +=
            "f " + QByteArray::number(a) + ' ' + QByteArray::number(b) + ' ' + QByteArray::number(c) + '\n';
    }
  return text;
}

/// Clicks Stop as soon as it is there.
class Stopper : public QObject {
 public:
  explicit Stopper(const QWidget& window) {
    startTimer(10);
    window_ = &window;
  }
  void timerEvent(QTimerEvent*) override {
    if (QProgressDialog* progress = progress_of(*window_))
      QTest::mouseClick(progress->findChild<QPushButton*>(), Qt::LeftButton);
  }

 private:
  const QWidget* window_;
};

}  // namespace

class BesideTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void the_window_goes_on_while_something_long_is_done() {
    WindowBench bench("wind");
    bench.action("play")->trigger();
    std::counting_semaphore<> enough(0);
    int frames = 0;
    connect(&bench.window.view(), &ClothView::frameDrawn, this, [&] {
      if (progress_of(bench.window) && ++frames == 3) enough.release();
    });
    const BesideResult result = beside_the_window(&bench.window, "Waiting for three pictures",
                                                  [&enough](const std::stop_token&) { enough.acquire(); });
    QVERIFY(!result.stopped);
    QVERIFY(frames >= 3);
    QVERIFY(!progress_of(bench.window));
  }

  void a_window_that_waits_does_not_close() {
    WindowBench bench("wind");
    auto enough = std::make_shared<std::binary_semaphore>(0);
    QTimer close;
    connect(&close, &QTimer::timeout, this, [&] {
      if (!progress_of(bench.window)) return;
      close.stop();
      bench.action("quit")->trigger();  // as another window's Quit does
      QVERIFY(!bench.window.close());
      QVERIFY(bench.window.isVisible());
      enough->release();
    });
    close.start(10);
    const BesideResult result = beside_the_window(&bench.window, "Waiting for a try to close",
                                                  [enough](const std::stop_token&) { enough->acquire(); });
    QVERIFY(!result.stopped);
    QVERIFY(bench.window.close());
  }

  void stop_returns_at_once_and_is_told_to_the_work() {
    WindowBench bench;
    const Stopper stopper(bench.window);
    auto told = std::make_shared<std::latch>(1);
    const BesideResult result =
        beside_the_window(&bench.window, "Waiting for Stop", [told](const std::stop_token& stop) {
          while (!stop.stop_requested()) QThread::msleep(1);
          told->count_down();
        });
    QVERIFY(result.stopped);
    QTRY_VERIFY_WITH_TIMEOUT(told->try_wait(), patience);
  }

  void a_failed_allocation_or_an_exception_is_a_message() {
    QWidget window;
    for (const int wait_ms : {0, 200}) {  // before and after the message is shown
      const BesideResult memory = beside_the_window(&window, "Failing", [wait_ms](const std::stop_token&) {
        QThread::msleep(static_cast<unsigned long>(wait_ms));
        throw std::bad_alloc();
      });
      QVERIFY(!memory.stopped);
      QVERIFY(!memory.failure.isEmpty());
    }
    const BesideResult other = beside_the_window(
        &window, "Failing", [](const std::stop_token&) { throw std::runtime_error("the disk is gone"); });
    QVERIFY2(other.failure.contains("the disk is gone"), qPrintable(other.failure));
  }

  /// The work outlives the window that asked for it.
  void a_window_is_closed_after_a_stop_without_waiting() {
    auto held = std::make_shared<std::binary_semaphore>(0);
    auto done = std::make_shared<std::atomic<bool>>(false);
    {
      WindowBench bench;
      const Stopper stopper(bench.window);
      const BesideResult result =
          beside_the_window(&bench.window, "Held", [held, done](const std::stop_token&) {
            held->acquire();
            *done = true;
          });
      QVERIFY(result.stopped);
    }
    QVERIFY(!*done);
    held->release();
    QTRY_VERIFY_WITH_TIMEOUT(*done, patience);
  }

  void points_that_are_no_longer_wanted_are_not_written() {
    WindowBench bench("wind");
    bench.play_until(0.1);
    bench.pause();
    const QTemporaryDir folder;
    const auto* charts = bench.window.findChild<ChartPanel*>();
    const QString path = folder.filePath("points.csv");
    std::stop_source stop;
    const auto write = charts->csvWriter(path);
    stop.request_stop();
    QVERIFY(!write(stop.get_token()).isEmpty());
    QVERIFY(!QFile::exists(path));
    QCOMPARE(write({}), QString());
    QVERIFY(QFile::exists(path));
  }

  void a_mesh_is_read_beside_the_window_by_drop_and_by_opening() {
    WindowBench bench;
    const QTemporaryDir folder;
    const auto write = [&folder](const char* name, const QByteArray& text) {
      QFile file(folder.filePath(name));
      if (!file.open(QIODevice::WriteOnly) || file.write(text) != text.size()) qFatal("no file");
      return file.fileName();
    };
    QVERIFY(!bench.window.open(write("broken.obj", "v 0 0\n")));
    QVERIFY(!bench.window.document().scene().cloth.is_mesh());
    QVERIFY(bench.window.open(write("square.obj", sheet_of(200))));
    QCOMPARE(bench.window.document().scene().cloth.columns, 200 * 200);
    QVERIFY(!progress_of(bench.window));
    bench.settle();
    QCOMPARE(bench.window.view().frame()->positions.size(), std::size_t{3 * 200 * 200});
  }
};

const Listed listed{"beside_test", test_main<BesideTest>};

}  // namespace clothlab::test::beside_test

#include "beside_test.moc"
