#include "answer_row.h"

#include <fmt/format.h>

#include <QApplication>
#include <QElapsedTimer>
#include <QMenu>
#include <QMenuBar>
#include <QMouseEvent>
#include <QSlider>
#include <functional>
#include <limits>

#include "bench_tools.h"
#include "main_window/lab_window.h"
#include "scene/builtin_scenes.h"

namespace clothlab {
namespace {

using json = nlohmann::ordered_json;

constexpr double patience = 10;  // s

/// Waits for the first paint of a widget after something was sent, and measures the time until then.
class PaintWatch : public QObject {
 public:
  explicit PaintWatch(std::function<bool(QObject*)> is_wanted) : is_wanted_(std::move(is_wanted)) {
    qApp->installEventFilter(this);
  }

  /// ms since `send` was called.
  double time(const std::function<void()>& send) {
    painted_ = false;
    clock_.start();
    send();
    QEventLoop loop;
    loop_ = &loop;
    QTimer::singleShot(static_cast<int>(1000 * patience), &loop, &QEventLoop::quit);
    if (!painted_) loop.exec();
    loop_ = nullptr;
    return painted_ ? 1e-6 * static_cast<double>(nanoseconds_) : std::numeric_limits<double>::infinity();
  }

  bool eventFilter(QObject* receiver, QEvent* event) override {
    if (event->type() != QEvent::Paint || painted_ || !is_wanted_(receiver)) return false;
    painted_ = true;
    // What is posted now comes after the painting.
    QTimer::singleShot(0, this, [this] {
      nanoseconds_ = clock_.nsecsElapsed();
      if (loop_) loop_->quit();
    });
    return false;
  }

 private:
  std::function<bool(QObject*)> is_wanted_;
  QElapsedTimer clock_;
  qint64 nanoseconds_ = 0;
  bool painted_ = false;
  QEventLoop* loop_ = nullptr;
};

/// As from the window system: behind all that waits in the queue.
void press(QWidget& widget, const QPoint& at) {
  QCoreApplication::postEvent(&widget, new QMouseEvent(QEvent::MouseButtonPress, at, widget.mapToGlobal(at),
                                                       Qt::LeftButton, Qt::LeftButton, {}));
}

void press(QWidget& widget, Qt::Key key) {
  QCoreApplication::postEvent(&widget, new QKeyEvent(QEvent::KeyPress, key, {}));
  QCoreApplication::postEvent(&widget, new QKeyEvent(QEvent::KeyRelease, key, {}));
}

json summary(const std::vector<double>& times) {
  return {{"median_ms", median(times)}, {"most_ms", quantile(times, 1)}};
}

}  // namespace

json answer_row(int side, int rounds) {
  LabWindow window;
  window.setAsksToSave(false);
  window.show();
  cloth::Scene scene = cloth::builtin_scene("wind");
  scene.cloth.rows = scene.cloth.columns = side;
  window.document().load(scene);
  window.simulation().send(command::Speed{std::numeric_limits<double>::infinity()});
  window.simulation().send(command::Play{});
  run_events(1.5);

  QMenuBar& bar = *window.menuBar();
  QMenu* const file = bar.actions().front()->menu();
  auto* editor = window.findChild<QWidget*>("param:springs.structural");
  auto* slider = editor ? editor->findChild<QSlider*>() : nullptr;
  std::vector<double> menu_times, slider_times;
  for (int round = 0; round < rounds && slider; ++round) {
    PaintWatch menu([file](QObject* receiver) { return receiver == file; });
    menu_times.push_back(menu.time([&] { press(bar, bar.actionGeometry(bar.actions().front()).center()); }));
    file->close();
    run_events(0.2);
    PaintWatch moved([slider](QObject* receiver) { return receiver == slider; });
    slider_times.push_back(
        moved.time([&] { press(*slider, round % 2 == 0 ? Qt::Key_Right : Qt::Key_Left); }));
    run_events(0.2);
  }
  const QSize size = window.view().size();
  const double drawn = window.simulation().status().real_time_factor;
  window.simulation().send(command::Pause{});
  window.simulation().settle();
  return {{"side", side},
          {"view_px", {size.width(), size.height()}},
          {"rounds", rounds},
          {"simulated_seconds_per_second", drawn},
          {"menu", summary(menu_times)},
          {"slider", summary(slider_times)}};
}

void print_answer_row(const json& row) {
  fmt::print(
      "\nanswers beside {0} x {0} particles: a menu after {1:.0f} ms ({2:.0f} at most), a slider after "
      "{3:.0f} ms ({4:.0f} at most), of {5}\n",
      row["side"].get<int>(), row["menu"]["median_ms"].get<double>(), row["menu"]["most_ms"].get<double>(),
      row["slider"]["median_ms"].get<double>(), row["slider"]["most_ms"].get<double>(),
      row["rounds"].get<int>());
}

}  // namespace clothlab
